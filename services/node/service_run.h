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

// The life of the service as a participant. It calls `settled` once it runs as it should: until
// then an exception, or a signal that would end it, brings it back with the profiles it had before.
// Gives the flags to come back with, or nothing where the process ends with `exit_code`.
using Live =
    std::function<std::optional<NewFlags>(const std::function<void()>& settled, int* exit_code)>;

// The exit code of `live`; it does not return where the process restarts. Throws what `live` does.
int RunService(const ServiceFlags& flags, const Scenario& scenario, const StopSignal& stop,
               const Live& live);

}  // namespace giveway
