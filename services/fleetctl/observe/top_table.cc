#include "services/fleetctl/observe/top_table.h"

#include <fmt/format.h>

#include "services/observer/fleet/sample_json.h"
#include "services/observer/fleet/sample_words.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kRowFormat = "{:>7}  {:<11}  {:<14}  {:>5}  {:>6}  {:>8}  {:>5}  {}";

double SpeedOf(const Beacon& beacon) {
  return TwistFromWheels(beacon.drive, beacon.wheels).forward_m_s;
}

std::string AgeText(std::optional<SteadyTime> heard_at, SteadyTime now) {
  return heard_at ? fmt::format("{:.0f} ms", Milliseconds(now - *heard_at)) : "-";
}

std::string EventsOf(const HeardVehicle& vehicle) {
  return vehicle.status ? EventsText(*vehicle.status) : "-";
}

// A vehicle that has fallen silent: its last state is history, its counts are not.
std::string PastRow(VehicleId id, const HeardVehicle& vehicle, SteadyTime now) {
  const Hearing hearing = vehicle.HearingAt(now);
  const auto heard_at = vehicle.HeardAt();
  const std::string since =
      heard_at ? fmt::format("for {:.0f} s", Seconds(now - *heard_at)) : "body in world";
  return fmt::format(kRowFormat, Number(id),
                     hearing == Hearing::kNever ? "not heard" : Name(hearing), since, "-", "-", "-",
                     "-", EventsOf(vehicle));
}

std::string StatusRow(VehicleId id, const HeardVehicle& vehicle, SteadyTime now) {
  const VehicleStatus& status = *vehicle.status;
  const std::string echo =
      status.nearest_echo_m ? fmt::format("{:.2f}", *status.nearest_echo_m) : "-";
  return fmt::format(kRowFormat, Number(id), giveway::Name(status.decision.mode),
                     ReasonText(status.decision), fmt::format("{:.2f}", status.forward_m_s), echo,
                     AgeText(vehicle.beacon_at, now), status.peers_heard, EventsOf(vehicle));
}

// A foreign peer, or one whose statuses do not arrive: only its beacons are known.
std::string BeaconRow(VehicleId id, const HeardVehicle& vehicle, SteadyTime now) {
  const Beacon& beacon = *vehicle.beacon;
  const Decision said{.mode = beacon.mode, .rule = beacon.rule, .peer = beacon.gives_way_to};
  return fmt::format(kRowFormat, Number(id), giveway::Name(said.mode), ReasonText(said),
                     fmt::format("{:.2f}", SpeedOf(beacon)), "-", AgeText(vehicle.beacon_at, now),
                     "-", "no status heard");
}

std::string Row(VehicleId id, const HeardVehicle& vehicle, SteadyTime now) {
  if (vehicle.HearingAt(now) != Hearing::kHeard) return PastRow(id, vehicle, now);
  return vehicle.status ? StatusRow(id, vehicle, now) : BeaconRow(id, vehicle, now);
}

bool IsWorldSilent(const HeardWorld& world, SteadyTime now) {
  return world.state != RunState::kEnded && now - *world.heard_at > HeardFleet::kSilentAfter;
}

std::string WorldText(const HeardWorld& world, SteadyTime now) {
  if (!world.heard_at) return "no world heard";
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

JsonObject WorldJson(const HeardWorld& world, SteadyTime now) {
  JsonObject object;
  object.Add("heard", world.heard_at.has_value());
  if (!world.heard_at) return object;
  object.Add("epoch", Number(world.epoch));
  if (world.state) object.Add("state", giveway::Name(*world.state));
  object.Add("silent", IsWorldSilent(world, now));
  object.Add("heard_s_ago", Seconds(now - *world.heard_at));
  object.Add("time_s", world.time_s);
  if (world.fleet_size > 0) object.Add("fleet_size", world.fleet_size);
  if (world.last_event) {
    JsonObject event;
    AddFields(*world.last_event, &event);
    object.Add("last_event", event);
  }
  return object;
}

JsonObject VehicleJson(VehicleId id, const HeardVehicle& vehicle, SteadyTime now) {
  JsonObject object;
  object.Add("id", Number(id));
  object.Add("hearing", Name(vehicle.HearingAt(now)));
  if (vehicle.HeardAt()) object.Add("heard_s_ago", Seconds(now - *vehicle.HeardAt()));
  if (vehicle.beacon) {
    object.Add("beacon_age_s", Seconds(now - *vehicle.beacon_at));
    object.Add("speed_m_s", SpeedOf(*vehicle.beacon));
  }
  if (vehicle.status) {
    JsonObject status;
    AddFields(*vehicle.status, &status);
    object.Add("status_age_s", Seconds(now - *vehicle.status_at));
    object.Add("status", status);
  }
  return object;
}

}  // namespace

std::vector<std::string> TopLines(const HeardFleet& fleet, const ListeningPost& post,
                                  SteadyTime now, TerminalSize size) {
  const HeardWorld& world = fleet.World();
  std::vector<std::string> head{
      fmt::format("{}  {}", WorldText(world, now), PostText(post)),
      world.last_event ? "last event: " + ToLine(*world.last_event) : "last event: none heard",
      fmt::format(kRowFormat, "vehicle", "mode", "reason", "m/s", "echo m", "beacon", "peers",
                  "events")};
  std::vector<std::string> rows;
  for (const auto& [id, vehicle] : fleet.Vehicles()) rows.push_back(Row(id, vehicle, now));
  if (!fleet.Anybody()) rows.push_back(NobodyHeard(post, now));
  return FitTerminal(std::move(head), rows, size);
}

std::string TopJson(const HeardFleet& fleet, const ListeningPost& post, SteadyTime now) {
  std::string vehicles;
  for (const auto& [id, vehicle] : fleet.Vehicles()) {
    if (!vehicles.empty()) vehicles += ',';
    vehicles += VehicleJson(id, vehicle, now).Text();
  }
  JsonObject object;
  object.Add("domain", post.domain);
  object.Add("interface", post.interface);
  object.Add("area", post.area);
  object.Add("listening_s", Seconds(now - post.since));
  object.Add("world", WorldJson(fleet.World(), now));
  object.AddRaw("vehicles", "[" + vehicles + "]");
  return object.Text();
}

std::string NobodyHeard(const ListeningPost& post, SteadyTime now) {
  return fmt::format(
      "nothing received for {:.1f} s in domain {} on interface {} in area {}: is a fleet running "
      "there? "
      "fleetctl run and the services' logs name its domain; --interface, --area and --qos must be "
      "those it was started with",
      Seconds(now - post.since), post.domain, post.interface, post.area);
}

}  // namespace giveway::fleetctl
