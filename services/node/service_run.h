// What giveway-vehicle and giveway-world do around their life as a participant: hold the profile
// set against the rules, or only try one; restart themselves when an order takes it, and come back
// with the set they had where the new one does not do.
#pragma once

#include <functional>
#include <optional>

#include "services/config/flags.h"
#include "services/runtime/process.h"
#include "services/runtime/restart.h"
#include "services/types/scenario.h"

namespace giveway {

// Runs `live`, which gives the flags to come back with, or nothing where the process ends with
// `exit_code`. The exit code; it does not return where the process restarts. Throws what `live`
// does.
int RunService(const ServiceFlags& flags, const Scenario& scenario, const StopSignal& stop,
               const std::function<std::optional<NewFlags>(int* exit_code)>& live);

}  // namespace giveway
