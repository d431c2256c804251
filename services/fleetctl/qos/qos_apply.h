// The verb `fleetctl qos apply`: gives running vehicles other QoS, one after the other, and on
// request one canary first. Values in; the exit code out.
#pragma once

#include "services/fleetctl/qos/qos_apply_options.h"

namespace giveway::fleetctl {

// 0 in effect everywhere, or nothing to do; 1 refused, rolled back, or not seen to be in effect;
// 2 could not run, and nothing was changed. Throws LinkError, InputError.
int RunQosApply(const QosApplyOptions& options);

}  // namespace giveway::fleetctl
