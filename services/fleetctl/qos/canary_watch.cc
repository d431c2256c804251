#include "services/fleetctl/qos/canary_watch.h"

#include "services/fleetctl/process/interrupts.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kSilence = std::chrono::seconds(1);  // it reports five times a second
constexpr Nanoseconds kWatchTurn = std::chrono::milliseconds(20);

}  // namespace

void CanaryWatch::Take() {
  SleepUntil(SteadyNow() + kWatchTurn);
  const SteadyTime now = SteadyNow();
  for (const VehicleStatus& status : observer_.Take().statuses) seen_.Add(status, now);
}

void CanaryWatch::WaitUntilSeen(VehicleId vehicle, std::chrono::milliseconds patience) {
  const SteadyTime end = SteadyNow() + patience;
  while (!seen_.Contains(vehicle) && SteadyNow() < end && Interrupts::Count() == 0) Take();
}

bool CanaryWatch::WaitUntilItHears(VehicleId vehicle, bool restarts,
                                   std::chrono::milliseconds patience) {
  const SteadyTime end = SteadyNow() + patience;
  const bool since_restart = restarts && seen_.Contains(vehicle);
  while (SteadyNow() < end && Interrupts::Count() == 0) {
    Take();
    if (seen_.Hears(vehicle, since_restart)) return true;
  }
  return false;
}

CanaryWatch::Both CanaryWatch::Watch(VehicleId vehicle, Nanoseconds span) {
  seen_ = {};
  const SteadyTime end = SteadyNow() + span;
  while (SteadyNow() < end && Interrupts::Count() == 0) Take();
  Both both;
  const auto ours = seen_.All().find(vehicle);
  if (ours == seen_.All().end() || end - ours->second.last_at > kSilence) {
    both.trouble = "it fell silent";
  } else if (ours->second.restarted) {
    both.trouble = "its process restarted";
  }
  for (const auto& [id, seen] : seen_.All()) {
    ServiceFigures& figures = id == vehicle ? both.canary : both.rest;
    figures += Between(seen.first, seen.last, Seconds(seen.last_at - seen.first_at));
  }
  return both;
}

}  // namespace giveway::fleetctl
