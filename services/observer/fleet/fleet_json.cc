#include "services/observer/fleet/fleet_json.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "services/observer/fleet/frame_json.h"
#include "services/observer/fleet/sample_format.h"
#include "services/observer/fleet/sample_json.h"

namespace giveway {
namespace {

Json AgeJson(std::optional<SteadyTime> at, SteadyTime now) {
  return at ? Json(Milliseconds(now - *at)) : Json();
}

template <typename Sample>
Json FieldsOf(const Sample& sample) {
  Json fields;
  AddFields(sample, &fields);
  return fields;
}

Json PoseJson(const Pose& pose) {
  Json object;
  object["x_m"] = pose.position_world.x;
  object["y_m"] = pose.position_world.y;
  object["heading_rad"] = pose.heading_rad;
  return object;
}

// The few fields by which a fleet is looked over.
Json RowJson(VehicleId id, const VehicleSnapshot& heard, const VehicleView* view, SteadyTime now) {
  Json row;
  row["vehicle"] = Number(id);
  row["hearing"] = Name(heard.LivenessAt(now));
  row["beacon_age_ms"] = AgeJson(heard.beacon_at, now);
  row["status_age_ms"] = AgeJson(heard.status_at, now);
  const Truth* body = view != nullptr ? view->Body() : nullptr;
  if (body != nullptr) {
    row["world_from_body"] = PoseJson(body->world_from_body);
    row["arrived"] = body->arrived;
  } else if (heard.beacon && (view == nullptr || !view->IsTakenOut())) {
    row["world_from_body"] = PoseJson(heard.beacon->world_from_body);
  }
  if (heard.beacon) {
    row["mode"] = Name(heard.beacon->mode);
    row["rule"] = Name(heard.beacon->rule);
    if (heard.beacon->gives_way_to != kNoVehicle) {
      row["gives_way_to"] = Number(heard.beacon->gives_way_to);
    }
    if (heard.beacon->blocked_by != kNoVehicle) {
      row["blocked_by"] = Number(heard.beacon->blocked_by);
    }
  }
  if (heard.status) {
    row["forward_m_s"] = heard.status->forward_m_s;
    row["nearest_echo_m"] = OrNull(heard.status->nearest_echo_m);
    row["peers_heard"] = heard.status->peers_heard;
  }
  return row;
}

Json WorldJson(const FleetView& view, SteadyTime now) {
  const WorldSnapshot& world = view.Heard().World();
  Json object;
  object["heard"] = world.IsHeard(now);
  if (!world.heard_at) return object;
  object["world_epoch"] = Number(world.epoch);
  if (world.state) object["run_state"] = Name(*world.state);
  object["time_s"] = world.time_s;
  object["fleet_size"] = world.fleet_size;
  object["age_ms"] = AgeJson(world.heard_at, now);
  if (view.Figures()) object["figures"] = FieldsOf(*view.Figures());
  return object;
}

}  // namespace

std::string FleetJson(const FleetView& view, SteadyTime now) {
  Json fleet;
  fleet["world"] = WorldJson(view, now);
  fleet["vehicles"] = JsonArray(view.Heard().Vehicles(), [&](const auto& entry) {
    return RowJson(entry.first, entry.second, view.Find(entry.first), now);
  });
  return JsonText(std::move(fleet));
}

std::optional<std::string> VehicleJson(const FleetView& view, VehicleId vehicle, SteadyTime now) {
  const auto found = view.Heard().Vehicles().find(vehicle);
  if (found == view.Heard().Vehicles().end()) return std::nullopt;
  const VehicleSnapshot& heard = found->second;
  Json object;
  object["vehicle"] = Number(vehicle);
  object["hearing"] = Name(heard.LivenessAt(now));
  object["beacon_age_ms"] = AgeJson(heard.beacon_at, now);
  object["status_age_ms"] = AgeJson(heard.status_at, now);
  const auto add = [&object](const char* name, const auto& sample) {
    if (sample) object[name] = FieldsOf(*sample);
  };
  std::optional<ReceivedBeacon> received;
  if (heard.beacon) {  // only valid ones are kept
    received.emplace();
    received->beacon = *heard.beacon;
    received->crc_valid = received->name_valid = true;
  }
  add("beacon", received);
  add("status", heard.status);
  if (const VehicleView* view_of = view.Find(vehicle)) {
    add("truth", view_of->truth);
    add("ranges", view_of->ranges);
  }
  return JsonText(std::move(object));
}

std::string EventsJson(const FleetView& view) {
  Json object;
  object["events"] = JsonArray(view.Events(), FieldsOf<WorldEvent>);
  return JsonText(std::move(object));
}

}  // namespace giveway
