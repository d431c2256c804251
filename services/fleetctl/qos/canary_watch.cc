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
  for (const VehicleStatus& status : observer_.Take().statuses) {
    const auto [entry, is_new] = seen_.try_emplace(status.vehicle);
    Seen& seen = entry->second;
    // A restarted process counts from zero.
    const bool restarted = !is_new && status.beacons.sent < seen.last.beacons.sent;
    seen.restarted |= restarted;
    if (is_new || restarted) {
      seen.first = status;
      seen.first_at = now;
    }
    seen.last = status;
    seen.last_at = now;
  }
}

bool CanaryWatch::WaitUntilItHears(VehicleId vehicle, std::chrono::milliseconds patience) {
  const SteadyTime end = SteadyNow() + patience;
  seen_.clear();
  while (SteadyNow() < end && Interrupts::Count() == 0) {
    Take();
    const auto ours = seen_.find(vehicle);
    if (ours == seen_.end()) continue;
    if (ours->second.last.beacons.taken > 0) return true;
  }
  return false;
}

CanaryWatch::Both CanaryWatch::Watch(VehicleId vehicle, Nanoseconds span) {
  seen_.clear();
  const SteadyTime end = SteadyNow() + span;
  while (SteadyNow() < end && Interrupts::Count() == 0) Take();
  Both both;
  const auto ours = seen_.find(vehicle);
  if (ours == seen_.end() || end - ours->second.last_at > kSilence) {
    both.trouble = "it fell silent";
  } else if (ours->second.restarted) {
    both.trouble = "its process restarted";
  }
  for (const auto& [id, seen] : seen_) {
    ServiceFigures& figures = id == vehicle ? both.canary : both.rest;
    figures += Between(seen.first, seen.last, Seconds(seen.last_at - seen.first_at));
  }
  return both;
}

}  // namespace giveway::fleetctl
