// What the library makes of a profile file, asked in a child process: a process keeps the first set
// it loads, and a file that crashes the library shall not end fleetctl. Called before this process
// touches the library, which starts threads.
#pragma once

#include <vector>

#include "services/link/resolved_qos.h"

namespace giveway::fleetctl {

// Throws LinkError with the child's words.
std::vector<link::ResolvedEntity> ResolveQosApart(const link::LinkOptions& options);

}  // namespace giveway::fleetctl
