#include "services/fleetctl/canary_watch.h"

#include <algorithm>

#include "services/app/process.h"
#include "services/fleetctl/interrupts.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kTurn = std::chrono::milliseconds(20);

}  // namespace

void CanaryWatch::Take() {
  app::SleepUntil(app::SteadyNow() + kTurn);
  const SteadyTime now = app::SteadyNow();
  for (const VehicleStatus& status : observer_.Take().statuses) {
    const auto [entry, is_new] = seen_.try_emplace(status.vehicle);
    Seen& seen = entry->second;
    // A process that began anew counts from nothing.
    if (is_new || status.beacons.sent < seen.last.beacons.sent) {
      seen.first = status;
      seen.first_at = now;
    }
    seen.last = status;
    seen.last_at = now;
  }
}

bool CanaryWatch::WaitUntilItHears(VehicleId vehicle, std::chrono::milliseconds patience) {
  const SteadyTime end = app::SteadyNow() + patience;
  seen_.clear();
  while (app::SteadyNow() < end && Interrupts::Count() == 0) {
    Take();
    const auto ours = seen_.find(vehicle);
    if (ours == seen_.end()) continue;
    const auto hears_more = [&](const auto& entry) {
      return entry.second.last.peers_heard > ours->second.last.peers_heard;
    };
    if (ours->second.last.peers_heard > 0 && std::ranges::none_of(seen_, hears_more)) return true;
  }
  return false;
}

CanaryWatch::Both CanaryWatch::Watch(VehicleId vehicle, Nanoseconds span) {
  seen_.clear();
  const SteadyTime end = app::SteadyNow() + span;
  while (app::SteadyNow() < end && Interrupts::Count() == 0) Take();
  Both both;
  for (const auto& [id, seen] : seen_) {
    ServiceFigures& figures = id == vehicle ? both.canary : both.rest;
    figures += Between(seen.first, seen.last, Seconds(seen.last_at - seen.first_at));
  }
  return both;
}

}  // namespace giveway::fleetctl
