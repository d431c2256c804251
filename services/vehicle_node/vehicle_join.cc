#include "services/vehicle_node/vehicle_join.h"

#include <algorithm>
#include <chrono>

#include "services/vehicle_node/asking.h"
#include "services/vehicle_node/vehicle_place.h"

namespace giveway {
namespace {

constexpr Nanoseconds kPoll = std::chrono::milliseconds(20);
constexpr Nanoseconds kReminder = std::chrono::seconds(5);

}  // namespace

VehicleOptions OptionsOf(const Scenario& scenario, const RosterEntry& entry) {
  const auto& known = entry.spawn == 0 ? scenario.vehicles : scenario.spawns;
  const auto found = entry.spawn == 0 ? std::ranges::find(known, entry.vehicle, &VehicleOptions::id)
                                      : known.begin() + std::min<std::ptrdiff_t>(entry.spawn - 1,
                                                                                 std::ssize(known));
  if (found == known.end()) {
    throw link::LinkError("the world gave this vehicle a place its scenario does not have: id " +
                          std::to_string(Number(entry.vehicle)) +
                          (entry.spawn == 0 ? "" : ", spawn " + std::to_string(entry.spawn)) +
                          "; start both with the same scenario file");
  }
  VehicleOptions options = *found;
  options.id = entry.vehicle;
  options.start_world = entry.start_world;
  return options;
}

std::optional<RosterEntry> Join(link::VehicleLink* link, Clock* clock, const StopSignal& stop,
                                VehicleId wanted, const std::optional<SessionId>& session,
                                VehicleHealthTeller* health) {
  Asking asking(link, clock, wanted, session);
  SteadyTime remind = clock->Now() + kReminder;
  while (!stop.IsSet()) {
    const auto entry = link->TakeRoster(asking.Session());
    if (entry && asking.IsFinal(*entry)) {
      if (!entry->accepted) LogRefusal(*entry);
      return entry;
    }
    asking.AskAgainIfDue();
    const std::string& answer = asking.WaitsFor();
    health->Joins(answer.empty() ? link->WhyNobodyIsFound() : answer);
    clock->SleepUntil(clock->Now() + kPoll);
    if (clock->Now() < remind) continue;
    remind += kReminder;
    const std::string change = link->InterfaceChange();
    if (!change.empty()) throw link::LinkError(change + "; ends, to be started again");
    if (asking.Answered()) continue;
    const std::string no_servers = link->WhyNobodyIsFound();
    LogWarning(!no_servers.empty()
                   ? no_servers
                   : "no answer from a world yet: is giveway-world running in this domain?");
  }
  link->SendLeave(asking.Session());
  return std::nullopt;
}

}  // namespace giveway
