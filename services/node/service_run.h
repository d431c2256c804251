// What giveway-vehicle and giveway-world do around their life as a participant: read the profile
// set and hold it against the rules, or only try one; restart themselves when an order takes it,
// and come back with the set they had where the new one does not do, or without shared memory where
// that is full.
#pragma once

#include <functional>
#include <optional>

#include "services/config/flags.h"
#include "services/link/fastdds/link_options.h"
#include "services/runtime/process.h"
#include "services/runtime/restart.h"
#include "services/types/scenario.h"

namespace giveway {

// How a life as a participant ended.
struct LifeEnd {
  int exit_code = 0;
  std::optional<NewFlags> back;  // to come back with; nothing: the process ends
};

inline constexpr const char* kSharedMemoryDeleted =
    "its shared memory was deleted or replaced, not all receive it: restarts itself over UDP alone";

// Where its shared memory was deleted it comes back without.
LifeEnd WithoutLostMemory(LifeEnd end, bool shared_memory_is_gone);

// The life of the service as a participant. It calls `settled` once it runs as it should: until
// then an exception, or a signal that would end it, brings it back with the profiles it had before.
using Live =
    std::function<LifeEnd(const link::LinkOptions& options, const std::function<void()>& settled)>;

// The exit code of `live`; it does not return where the process restarts. Throws what `live` does.
int RunService(const ServiceFlags& flags, const Scenario& scenario, const StopSignal& stop,
               const Live& live);

}  // namespace giveway
