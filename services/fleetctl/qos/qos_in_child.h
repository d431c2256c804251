// How the library resolves a profile file, in a child process: a process keeps the first set it
// loads, and a file that crashes the library must not end fleetctl. Call it before this process
// uses the library, which starts threads.
#pragma once

#include <vector>

#include "services/link/resolved_qos.h"

namespace giveway::fleetctl {

// Throws LinkError with the child's message.
std::vector<link::ResolvedEntity> ResolveQosInChild(const link::LinkOptions& options);

}  // namespace giveway::fleetctl
