#include "services/vehicle_node/vehicle_join.h"

#include <algorithm>
#include <chrono>

#include "services/link/fastdds/link_options.h"
#include "services/node/interface_check.h"
#include "services/runtime/process.h"
#include "services/runtime/refusal_log.h"
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

// What the vehicle of the entry drives by; null where the scenario has no such place.
const VehicleOptions* PlaceOf(const Scenario& scenario, const RosterEntry& entry) {
  if (entry.spawn != 0) {
    return entry.spawn <= scenario.spawns.size() ? &scenario.spawns[entry.spawn - 1] : nullptr;
  }
  const auto own = std::ranges::find(scenario.vehicles, entry.vehicle, &VehicleOptions::id);
  return own == scenario.vehicles.end() ? nullptr : &*own;
}

bool IsPlace(const RosterEntry& entry, VehicleId wanted, const JoinParts& parts,
             RefusalLog* refusals) {
  if (!entry.accepted) return true;
  OptionsOf(*parts.scenario, entry);  // throws where the world has another scenario
  const std::string why = WhyNoPlace(*parts.scenario, entry, wanted);
  if (why.empty()) return true;
  const Refusal refusal = RefusalOf(entry, why);
  LogNews({&refusal, 1}, {}, parts.clock->Now(), refusals);
  return false;
}

}  // namespace

VehicleOptions OptionsOf(const Scenario& scenario, const RosterEntry& entry) {
  const VehicleOptions* const place = PlaceOf(scenario, entry);
  if (place == nullptr) {
    throw link::LinkError("the world gave this vehicle a place its scenario does not have: id " +
                          std::to_string(Number(entry.vehicle)) +
                          (entry.spawn == 0 ? "" : ", spawn " + std::to_string(entry.spawn)) +
                          "; start both with the same scenario file");
  }
  VehicleOptions options = *place;
  options.id = entry.vehicle;
  options.start_world = entry.start_world;
  return options;
}

std::string WhyNoPlace(const Scenario& scenario, const RosterEntry& entry, VehicleId own) {
  if (!entry.accepted) return {};
  if (own != kNoVehicle && entry.vehicle != own) {
    return "vehicle is " + std::to_string(Number(entry.vehicle)) + ", must be " +
           std::to_string(Number(own));
  }
  const VehicleOptions* const place = PlaceOf(scenario, entry);
  if (place == nullptr) {
    return "the scenario has no such place: spawn " + std::to_string(entry.spawn);
  }
  // With neither it drives straight on, as far as its run lasts.
  if (!place->goal.set && !place->route.loop) return {};
  if (IsNear(scenario, entry.start_world.position_world)) return {};
  return "start_world is far from all places of the scenario";
}

Refusal RefusalOf(const RosterEntry& entry, const std::string& why) {
  return {.sample = "roster entry",
          .vehicle = entry.vehicle,
          .counter = "not followed",
          .field = "start_world",
          .why = why};
}

JoinEnd Join(const JoinParts& parts, const std::function<bool()>& is_stopped, VehicleId wanted,
             const std::optional<SessionId>& session) {
  link::DriveLink& link = *parts.link;
  Clock& clock = *parts.clock;
  Asking asking(&link, &clock, wanted, session);
  RefusalLog refusals;
  InterfaceCheck interface([&link] { return link.InterfaceChange(); });
  SteadyTime remind = clock.Now() + kReminder;
  while (!is_stopped()) {
    const auto entry = link.TakeRoster(asking.Session());
    if (entry && IsPlace(*entry, wanted, parts, &refusals) && asking.IsFinal(*entry)) {
      if (!entry->accepted) LogRefusal(*entry);
      return {.entry = entry};
    }
    asking.AskAgainIfDue();
    const std::string& answer = asking.WaitsFor();
    parts.health->OnJoining(answer.empty() ? link.WhyNoPeerIsFound() : answer);
    clock.SleepUntil(clock.Now() + kPoll);
    if (clock.Now() < remind) continue;
    remind += kReminder;
    // Whatever was heard: an answer may be older than the change.
    if (interface.MustEnd(clock.Now(), false))
      return {.entry = std::nullopt, .interface_lost = true};
    if (asking.Answered()) continue;
    const std::string no_servers = link.WhyNoPeerIsFound();
    LogWarning(!no_servers.empty()
                   ? no_servers
                   : "no answer from a world yet: is giveway-world running in this domain?");
  }
  link.SendLeave(asking.Session());
  return {};
}

}  // namespace giveway
