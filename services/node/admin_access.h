// Which operators may give orders to this service, by its flags.
#pragma once

#include "services/auth/admin_gate.h"
#include "services/config/flags.h"
#include "services/link/service_options.h"
#include "services/types/scenario.h"

namespace giveway {

// Throws auth::KeyError.
auth::AdminGate AdminGateOf(const ServiceFlags& flags);

link::ServiceOptions ServiceOptionsOf(const auth::AdminGate& gate, const Scenario& scenario);

}  // namespace giveway
