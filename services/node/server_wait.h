// What giveway-vehicle and giveway-world do before they become participants: a discovery server
// named by host may start after them, and has no address until then.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/link/fastdds/link_options.h"
#include "services/runtime/process.h"

namespace giveway {

// Waits until every discovery server has an address, and passes the reason to `tell` repeatedly
// meanwhile, and an empty one when it is over. The addresses, for the link: looked up once more,
// slowly, the watchdog would end the process. Nothing if asked to stop.
std::optional<std::vector<link::ServerAddress>> AwaitServers(
    const link::LinkOptions& options, const StopSignal& stop,
    const std::function<void(const std::string& why)>& tell);

}  // namespace giveway
