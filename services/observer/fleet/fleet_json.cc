#include "services/observer/fleet/fleet_json.h"

#include "services/observer/fleet/frame_json.h"
#include "services/observer/fleet/sample_json.h"
#include "services/observer/fleet/sample_words.h"

namespace giveway {
namespace {

void AddAge(std::string_view name, std::optional<SteadyTime> at, SteadyTime now,
            JsonObject* object) {
  if (at) object->Add(name, Milliseconds(now - *at));
}

std::string PoseJson(const Pose& pose) {
  JsonObject object;
  object.Add("x_m", pose.position_world.x);
  object.Add("y_m", pose.position_world.y);
  object.Add("heading_rad", pose.heading_rad);
  return object.Text();
}

// The few fields by which a fleet is looked over.
std::string RowJson(VehicleId id, const HeardVehicle& heard, const VehicleView* view,
                    SteadyTime now) {
  JsonObject row;
  row.Add("vehicle", Number(id));
  row.Add("hearing", Name(heard.HearingAt(now)));
  AddAge("beacon_age_ms", heard.beacon_at, now, &row);
  AddAge("status_age_ms", heard.status_at, now, &row);
  const Truth* body = view != nullptr ? view->Body() : nullptr;
  if (body != nullptr) {
    row.AddRaw("world_from_body", PoseJson(body->world_from_body));
    row.Add("arrived", body->arrived);
  } else if (heard.beacon) {
    row.AddRaw("world_from_body", PoseJson(heard.beacon->world_from_body));
  }
  if (heard.beacon) {
    row.Add("mode", Name(heard.beacon->mode));
    row.Add("rule", Name(heard.beacon->rule));
    if (heard.beacon->gives_way_to != kNobody) {
      row.Add("gives_way_to", Number(heard.beacon->gives_way_to));
    }
    if (heard.beacon->blocked_by != kNobody) {
      row.Add("blocked_by", Number(heard.beacon->blocked_by));
    }
  }
  if (heard.status) {
    row.Add("forward_m_s", heard.status->forward_m_s);
    row.Add("nearest_echo_m", heard.status->nearest_echo_m);
    row.Add("peers_heard", heard.status->peers_heard);
  }
  return row.Text();
}

std::string WorldJson(const FleetView& view, SteadyTime now) {
  const HeardWorld& world = view.Heard().World();
  JsonObject object;
  object.Add("heard", world.heard_at.has_value());
  if (!world.heard_at) return object.Text();
  object.Add("world_epoch", Number(world.epoch));
  if (world.state) object.Add("run_state", Name(*world.state));
  object.Add("time_s", world.time_s);
  object.Add("fleet_size", world.fleet_size);
  AddAge("age_ms", world.heard_at, now, &object);
  if (view.Figures()) {
    JsonObject figures;
    AddFields(*view.Figures(), &figures);
    object.Add("figures", figures);
  }
  return object.Text();
}

}  // namespace

std::string FleetJson(const FleetView& view, SteadyTime now) {
  JsonObject fleet;
  fleet.AddRaw("world", WorldJson(view, now));
  fleet.AddRaw("vehicles", JsonArray(view.Heard().Vehicles(), [&](const auto& entry) {
                 return RowJson(entry.first, entry.second, view.Find(entry.first), now);
               }));
  return fleet.Text();
}

std::optional<std::string> VehicleJson(const FleetView& view, VehicleId vehicle, SteadyTime now) {
  const auto found = view.Heard().Vehicles().find(vehicle);
  if (found == view.Heard().Vehicles().end()) return std::nullopt;
  const HeardVehicle& heard = found->second;
  JsonObject object;
  object.Add("vehicle", Number(vehicle));
  object.Add("hearing", Name(heard.HearingAt(now)));
  AddAge("beacon_age_ms", heard.beacon_at, now, &object);
  AddAge("status_age_ms", heard.status_at, now, &object);
  const auto add = [&object](std::string_view name, const auto& sample) {
    if (!sample) return;
    JsonObject fields;
    AddFields(*sample, &fields);
    object.Add(name, fields);
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
  return object.Text();
}

std::string EventsJson(const FleetView& view) {
  JsonObject object;
  object.AddRaw("events", JsonArray(view.Events(), [](const WorldEvent& event) {
                  JsonObject fields;
                  AddFields(event, &fields);
                  return fields.Text();
                }));
  return object.Text();
}

}  // namespace giveway
