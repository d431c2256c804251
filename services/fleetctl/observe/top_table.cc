#include "services/fleetctl/observe/top_table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "services/observer/fleet/sample_format.h"
#include "services/observer/fleet/sample_json.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kRowFormat = "{:>7}  {:<11}  {:<14}  {:>5}  {:>6}  {:>8}  {:>5}  {}";

double SpeedOf(const Beacon& beacon) {
  return TwistFromWheels(beacon.drive, beacon.wheels).forward_m_s;
}

std::string AgeText(std::optional<SteadyTime> heard_at, SteadyTime now) {
  return heard_at ? fmt::format("{:.0f} ms", Milliseconds(now - *heard_at)) : "-";
}

std::string EventsOf(const VehicleSnapshot& vehicle) {
  return vehicle.status ? EventsText(*vehicle.status) : "-";
}

// A vehicle that has fallen silent: its last state is history, its counts are not.
std::string PastRow(VehicleId id, const VehicleSnapshot& vehicle, SteadyTime now) {
  const Liveness liveness = vehicle.LivenessAt(now);
  const auto heard_at = vehicle.HeardAt();
  const std::string since =
      heard_at ? fmt::format("for {:.0f} s", Seconds(now - *heard_at)) : "body in world";
  return fmt::format(kRowFormat, Number(id),
                     liveness == Liveness::kNever ? "not heard" : Name(liveness), since, "-", "-",
                     "-", "-", EventsOf(vehicle));
}

std::string StatusRow(VehicleId id, const VehicleSnapshot& vehicle, SteadyTime now) {
  const VehicleStatus& status = *vehicle.status;
  const std::string echo =
      status.nearest_echo_m ? fmt::format("{:.2f}", *status.nearest_echo_m) : "-";
  return fmt::format(kRowFormat, Number(id), giveway::Name(status.decision.mode),
                     ReasonText(status.decision), fmt::format("{:.2f}", status.forward_m_s), echo,
                     AgeText(vehicle.beacon_at, now), status.peers_heard, EventsOf(vehicle));
}

// A foreign peer, or one whose statuses do not arrive: only its beacons are known.
std::string BeaconRow(VehicleId id, const VehicleSnapshot& vehicle, SteadyTime now) {
  const Beacon& beacon = *vehicle.beacon;
  const Decision said{.mode = beacon.mode, .rule = beacon.rule, .peer = beacon.gives_way_to};
  return fmt::format(kRowFormat, Number(id), giveway::Name(said.mode), ReasonText(said),
                     fmt::format("{:.2f}", SpeedOf(beacon)), "-", AgeText(vehicle.beacon_at, now),
                     "-", "no status heard");
}

std::string Row(VehicleId id, const VehicleSnapshot& vehicle, SteadyTime now) {
  if (vehicle.LivenessAt(now) != Liveness::kHeard) return PastRow(id, vehicle, now);
  return vehicle.status ? StatusRow(id, vehicle, now) : BeaconRow(id, vehicle, now);
}

bool IsWorldSilent(const WorldSnapshot& world, SteadyTime now) {
  return world.state != RunState::kEnded && !world.IsHeard(now);
}

std::string WorldText(const WorldSnapshot& world, SteadyTime now) {
  if (!world.heard_at) return world.IsHeard(now) ? "world without vehicles" : "no world heard";
  std::string text = fmt::format(
      "world {}", world.state ? giveway::Name(*world.state) : std::string_view("heard"));
  if (world.time_s > 0) text += fmt::format(", {:.1f} s", world.time_s);
  if (IsWorldSilent(world, now)) {
    text += fmt::format(", silent for {:.0f} s", Seconds(now - *world.heard_at));
  }
  return text;
}

std::string PostText(const ListeningPost& post) {
  return fmt::format("domain {}  {}  area {}", post.domain, post.interface, post.area);
}

Json WorldJson(const WorldSnapshot& world, SteadyTime now) {
  Json object;
  object["heard"] = world.IsHeard(now);
  if (!world.heard_at) return object;
  object["epoch"] = Number(world.epoch);
  if (world.state) object["state"] = giveway::Name(*world.state);
  object["silent"] = IsWorldSilent(world, now);
  object["heard_s_ago"] = Seconds(now - *world.heard_at);
  object["time_s"] = world.time_s;
  if (world.fleet_size > 0) object["fleet_size"] = world.fleet_size;
  if (world.last_event) {
    AddFields(*world.last_event, &object["last_event"]);
  }
  return object;
}

Json VehicleJson(VehicleId id, const VehicleSnapshot& vehicle, SteadyTime now) {
  Json object;
  object["id"] = Number(id);
  object["hearing"] = Name(vehicle.LivenessAt(now));
  if (vehicle.HeardAt()) object["heard_s_ago"] = Seconds(now - *vehicle.HeardAt());
  if (vehicle.beacon) {
    object["beacon_age_s"] = Seconds(now - *vehicle.beacon_at);
    object["speed_m_s"] = SpeedOf(*vehicle.beacon);
  }
  if (vehicle.status) {
    object["status_age_s"] = Seconds(now - *vehicle.status_at);
    AddFields(*vehicle.status, &object["status"]);
  }
  return object;
}

}  // namespace

std::vector<std::string> TopLines(const FleetSnapshot& fleet, const ListeningPost& post,
                                  SteadyTime now, TerminalSize size) {
  const WorldSnapshot& world = fleet.World();
  std::vector<std::string> head{
      fmt::format("{}  {}", WorldText(world, now), PostText(post)),
      world.last_event ? "last event: " + ToLine(*world.last_event) : "last event: none heard",
      fmt::format(kRowFormat, "vehicle", "mode", "reason", "m/s", "echo m", "beacon", "peers",
                  "events")};
  std::vector<std::string> rows;
  for (const auto& [id, vehicle] : fleet.Vehicles()) rows.push_back(Row(id, vehicle, now));
  if (!fleet.IsAnyHeard() && !world.IsHeard(now)) rows.push_back(NothingHeard(post, now));
  return FitTerminal(std::move(head), rows, size);
}

std::string TopJson(const FleetSnapshot& fleet, const ListeningPost& post, SteadyTime now) {
  Json object;
  object["domain"] = post.domain;
  object["interface"] = post.interface;
  object["area"] = post.area;
  object["listening_s"] = Seconds(now - post.since);
  object["world"] = WorldJson(fleet.World(), now);
  object["vehicles"] = JsonArray(fleet.Vehicles(), [now](const auto& entry) {
    return VehicleJson(entry.first, entry.second, now);
  });
  return JsonText(std::move(object));
}

std::string NothingHeard(const ListeningPost& post, SteadyTime now) {
  return fmt::format(
      "nothing received for {:.1f} s in domain {} on interface {} in area {}: is a fleet running "
      "there? "
      "fleetctl run and the services' logs name its domain; --interface, --area and --qos must be "
      "those it was started with",
      Seconds(now - post.since), post.domain, post.interface, post.area);
}

}  // namespace giveway::fleetctl
