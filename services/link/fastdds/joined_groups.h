// What a socket of this process hears of multicasts. By default Linux hands it those to its group
// from every interface on which any program of the machine joined that group.
#pragma once

#include <cstdint>

namespace giveway::link {

// From now on the IPv4 UDP sockets of this process that are bound to `port` hear the groups they
// joined, on the interfaces they joined them on. Returns how many there are; -1 where one refused.
int HearJoinedInterfacesOnly(std::uint16_t port);

}  // namespace giveway::link
