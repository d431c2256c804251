// Listens to the UDP packets that pass an interface, as an intruder with a packet socket does.
#pragma once

#include <netinet/in.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace giveway::attack {

struct Packet {
  in_addr to{};
  std::uint16_t port = 0;
  std::vector<std::uint8_t> bytes;  // of the datagram
};

// RTPS packets to that port range, until so many are there or the time is over. Throws
// std::system_error; needs the right to open packet sockets.
std::vector<Packet> Capture(const std::string& interface, std::uint16_t first_port,
                            std::uint16_t last_port, std::size_t most,
                            std::chrono::milliseconds time);

}  // namespace giveway::attack
