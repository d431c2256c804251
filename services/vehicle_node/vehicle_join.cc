#include "services/vehicle_node/vehicle_join.h"

#include <algorithm>
#include <chrono>

#include "services/vehicle_node/asking.h"
#include "services/vehicle_node/vehicle_place.h"

namespace giveway {
namespace {

constexpr Nanoseconds kPoll = std::chrono::milliseconds(20);
constexpr Nanoseconds kReminder = std::chrono::seconds(5);

// A vehicle may have been pushed, or have gone round something, but not by so much.
constexpr double kBeyond_m = 50;

// Whether a place lies within the rectangle round all starts and routes, or little beyond it.
bool IsNear(const Scenario& scenario, Vec2 place_world) {
  Vec2 low = scenario.crossing_world;
  Vec2 high = low;
  const auto cover = [&](Vec2 point) {
    low = {std::min(low.x, point.x), std::min(low.y, point.y)};
    high = {std::max(high.x, point.x), std::max(high.y, point.y)};
  };
  for (const auto* places : {&scenario.vehicles, &scenario.spawns}) {
    for (const VehicleOptions& options : *places) {
      cover(options.start_world.position_world);
      if (options.goal.set) cover(options.goal.at_world);
      for (std::size_t i = 0; i < options.route.count; ++i) cover(options.route.waypoints_world[i]);
    }
  }
  return place_world.x >= low.x - kBeyond_m && place_world.x <= high.x + kBeyond_m &&
         place_world.y >= low.y - kBeyond_m && place_world.y <= high.y + kBeyond_m;
}

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

std::string WhyNoPlace(const Scenario& scenario, const RosterEntry& entry, VehicleId own) {
  if (!entry.accepted) return {};
  if (entry.vehicle != own) return "vehicle is " + std::to_string(Number(entry.vehicle));
  const bool known = entry.spawn == 0
                         ? std::ranges::find(scenario.vehicles, own, &VehicleOptions::id) !=
                               scenario.vehicles.end()
                         : entry.spawn <= scenario.spawns.size();
  if (!known) return "the scenario has no such place: spawn " + std::to_string(entry.spawn);
  if (IsNear(scenario, entry.start_world.position_world)) return {};
  return "start_world is far from all places of the scenario";
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
