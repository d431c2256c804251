#include "services/observer/fleet/frame_json.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/observer/fleet/sample_format.h"
#include "services/observer/fleet/sample_json.h"

namespace giveway {
namespace {

constexpr std::int64_t kNone = -1;

// A thousandth of the unit; what is not finite or absurd is at the limit, for the page draws it.
std::int64_t Milli(double value) {
  constexpr double kMost = 1e9;
  if (std::isnan(value)) return 0;
  return std::llround(std::clamp(value * 1e3, -kMost, kMost));
}

std::int64_t SquareMilli(double value) { return Milli(value * 1e3); }

std::int64_t AgeMs(std::optional<SteadyTime> heard_at, SteadyTime now) {
  return heard_at ? static_cast<std::int64_t>(Milliseconds(now - *heard_at)) : kNone;
}

struct BodyView {
  bool is_there = false;
  Pose world_from_body;
  double forward_m_s = 0;
  bool arrived = false;
};

// As the world says, or where it has said nothing, as the vehicle does.
BodyView BodyOf(const VehicleSnapshot& heard, const VehicleView* view) {
  if (view != nullptr && view->IsTakenOut()) return {};
  if (const Truth* truth = view != nullptr ? view->Body() : nullptr) {
    return {true, truth->world_from_body, truth->forward_m_s, truth->arrived};
  }
  if (heard.beacon) {
    const Beacon& beacon = *heard.beacon;
    return {true, beacon.world_from_body, TwistFromWheels(beacon.drive, beacon.wheels).forward_m_s,
            false};
  }
  return {.forward_m_s = heard.status ? heard.status->forward_m_s : 0};
}

// The status names the peer of a decision, the beacon comes more often.
Decision DecisionOf(const VehicleSnapshot& heard) {
  Decision decision;
  if (heard.status) decision = heard.status->decision;
  if (heard.beacon) {
    const bool same = decision.rule == heard.beacon->rule;
    decision.mode = heard.beacon->mode;
    decision.rule = heard.beacon->rule;
    if (!same) decision.peer = heard.beacon->gives_way_to;
  }
  return decision;
}

using Row = std::array<std::int64_t, kVehicleColumns.size()>;

Row RowOf(VehicleId id, const VehicleSnapshot& heard, const VehicleView* view, SteadyTime now) {
  const BodyView body = BodyOf(heard, view);
  const Beacon beacon = heard.beacon.value_or(Beacon{});
  const Decision decision = DecisionOf(heard);
  const auto reaction = view != nullptr ? view->reaction.Newest_us() : std::nullopt;
  return {
      Number(id),
      Milli(body.world_from_body.position_world.x),
      Milli(body.world_from_body.position_world.y),
      Milli(body.world_from_body.heading_rad),
      Milli(body.forward_m_s),
      static_cast<std::int64_t>(heard.LivenessAt(now)),
      static_cast<std::int64_t>(decision.mode),
      static_cast<std::int64_t>(decision.rule),
      Number(decision.peer),
      Number(beacon.gives_way_to),
      Number(beacon.blocked_by),
      AgeMs(heard.beacon_at, now),
      heard.status && heard.status->nearest_echo_m ? Milli(*heard.status->nearest_echo_m) : kNone,
      Milli(beacon.world_from_body.position_world.x),
      Milli(beacon.world_from_body.position_world.y),
      SquareMilli(beacon.covariance.xx_m2),
      SquareMilli(beacon.covariance.xy_m2),
      SquareMilli(beacon.covariance.yy_m2),
      Milli(beacon.body_radius_m),
      reaction ? static_cast<std::int64_t>(*reaction / 1000) : kNone,
      heard.status ? heard.status->peers_heard : kNone,
      body.arrived ? 1 : 0,
      Milli(beacon.toward_world.x),
      Milli(beacon.toward_world.y),
      body.is_there ? 1 : 0,
  };
}

Json RowsJson(const FleetView& view, SteadyTime now) {
  return JsonArray(view.Heard().Vehicles(), [&](const auto& entry) {
    return RowOf(entry.first, entry.second, view.Find(entry.first), now);
  });
}

std::int64_t RangeOf(const RangeReading& reading) {
  constexpr std::int64_t kClear = -1;
  constexpr std::int64_t kNoData = -2;
  if (reading.kind == Echo::kEcho) return Milli(reading.range_m);
  return reading.kind == Echo::kClear ? kClear : kNoData;
}

Json RangesJson(const FleetView& view, SteadyTime now) {
  Json object = Json::object();
  if (view.Heard().Vehicles().size() > kMostWithRanges) return object;
  for (const auto& [id, heard] : view.Heard().Vehicles()) {
    const VehicleView* vehicle = view.Find(id);
    if (vehicle == nullptr || !vehicle->ranges) continue;
    if (now - vehicle->ranges_at > FleetSnapshot::kSilentAfter) continue;
    object[std::to_string(Number(id))] = JsonArray(vehicle->ranges->readings, RangeOf);
  }
  return object;
}

Json WorldJson(const WorldSnapshot& world, SteadyTime now) {
  Json object;
  object["epoch"] = Number(world.epoch);
  if (world.state) object["state"] = Name(*world.state);
  object["time_ms"] = Milli(world.time_s);
  object["fleet_size"] = world.fleet_size;
  object["heard"] = world.IsHeard(now);  // also of one that has nothing to say
  object["age_ms"] = AgeMs(world.heard_at, now);
  return object;
}

Json SignalsJson(const FleetView& view) {
  return JsonArray(view.Signals(), [](const auto& entry) {
    const SignalState& signal = entry.second;
    return std::array<std::int64_t, 7>{Number(signal.id),
                                       Milli(signal.line_from_world.x),
                                       Milli(signal.line_from_world.y),
                                       Milli(signal.line_to_world.x),
                                       Milli(signal.line_to_world.y),
                                       static_cast<std::int64_t>(signal.phase),
                                       Milli(signal.to_change_s)};
  });
}

Json NewestEventsJson(const FleetView& view, std::size_t most) {
  const auto& events = view.Events();
  const std::size_t skipped = events.size() > most ? events.size() - most : 0;
  Json json = Json::array();
  for (auto event = events.begin() + static_cast<std::ptrdiff_t>(skipped); event != events.end();
       ++event) {
    AddFields(*event, &json.emplace_back());
  }
  return json;
}

}  // namespace

std::string FrameJson(const FleetView& view, SteadyTime now, std::size_t most_events) {
  Json frame;
  frame["at_ms"] = static_cast<std::int64_t>(Milliseconds(now));
  frame["world"] = WorldJson(view.Heard().World(), now);
  frame["vehicles"] = RowsJson(view, now);
  frame["ranges"] = RangesJson(view, now);
  frame["signals"] = SignalsJson(view);
  frame["events"] = NewestEventsJson(view, most_events);
  return JsonText(std::move(frame));
}

}  // namespace giveway
