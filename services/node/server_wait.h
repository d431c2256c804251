// What giveway-vehicle and giveway-world do before they become participants: a discovery server
// named by host may start after them, and has no address until then.
#pragma once

#include <functional>
#include <string>

#include "services/link/fastdds/link_options.h"
#include "services/runtime/process.h"

namespace giveway {

// Waits until every discovery server has an address, and passes the reason to `tell` repeatedly
// meanwhile. False if asked to stop.
bool AwaitServers(const link::LinkOptions& options, const StopSignal& stop,
                  const std::function<void(const std::string& why)>& tell);

}  // namespace giveway
