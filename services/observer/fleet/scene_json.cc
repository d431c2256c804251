#include "services/observer/fleet/scene_json.h"

#include <fmt/format.h>

#include "services/observer/fleet/frame_json.h"
#include "services/observer/fleet/json_object.h"
#include "services/observer/fleet/sample_words.h"

namespace giveway {
namespace {

std::string NameJson(std::string_view name) { return fmt::format("\"{}\"", name); }

template <typename Enum>
std::string NamesUpTo(Enum last) {
  std::string json;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(last); ++i) {
    json += (json.empty() ? "" : ",") + NameJson(Name(static_cast<Enum>(i)));
  }
  return "[" + json + "]";
}

std::string PointJson(Vec2 point) { return fmt::format("[{},{}]", point.x, point.y); }

std::string SonarJson(const VehicleProfile& profile) {
  JsonObject object;
  object.Add("half_angle_rad", profile.sonar_half_angle_rad);
  object.Add("max_range_m", profile.sonar_max_range_m);
  object.AddRaw("mounts", JsonArray(profile.sonar, [](const SensorMount& mount) {
                  return fmt::format("[{},{},{}]", mount.position_body.x, mount.position_body.y,
                                     mount.bearing_rad);
                }));
  return object.Text();
}

std::string ObstacleJson(const Obstacle& obstacle) {
  JsonObject object;
  object.AddRaw("at", PointJson(obstacle.start_world.position_world));
  object.Add("heading_rad", obstacle.start_world.heading_rad);
  if (obstacle.shape == BodyShape::kBox) {
    object.AddRaw("box_half_m", PointJson(obstacle.box_half_m));
  } else {
    object.Add("radius_m", obstacle.radius_m);
  }
  object.AddRaw("waypoints", JsonArray(obstacle.waypoints_world, PointJson));
  return object.Text();
}

std::string DoorJson(const Door& door) {
  JsonObject object;
  object.AddRaw("from", PointJson(door.from_world));
  object.AddRaw("to", PointJson(door.to_world));
  object.Add("closed_s", door.closed_s);
  object.Add("open_s", door.open_s);
  object.Add("move_s", door.move_s);
  object.Add("offset_s", door.offset_s);
  return object.Text();
}

std::string VehicleJson(const VehicleOptions& vehicle) {
  JsonObject object;
  object.Add("id", Number(vehicle.id));
  if (vehicle.profile.shape == BodyShape::kBox) {
    object.AddRaw("box_half_m", PointJson(vehicle.profile.box_half_m));
  }
  if (vehicle.goal.set) object.AddRaw("goal", PointJson(vehicle.goal.at_world));
  return object.Text();
}

void AddScenario(const Scenario& scenario, JsonObject* scene) {
  scene->Add("scenario", scenario.name);
  scene->AddRaw("walls", JsonArray(scenario.walls, [](const Wall& wall) {
                  return fmt::format("[{},{},{},{}]", wall.from_world.x, wall.from_world.y,
                                     wall.to_world.x, wall.to_world.y);
                }));
  scene->AddRaw("obstacles", JsonArray(scenario.obstacles, ObstacleJson));
  scene->AddRaw("doors", JsonArray(scenario.doors, DoorJson));
  scene->AddRaw("fleet", JsonArray(scenario.vehicles, VehicleJson));
}

}  // namespace

std::string SceneJson(const SceneSource& source) {
  JsonObject scene;
  scene.Add("title", source.title);
  scene.AddRaw("columns", JsonArray(kVehicleColumns, NameJson));
  scene.AddRaw("hearings", NamesUpTo(Hearing::kLeft));
  scene.AddRaw("modes", NamesUpTo(Mode::kLeaving));
  scene.AddRaw("rules", NamesUpTo(Rule::kLeaving));
  scene.AddRaw("phases", NamesUpTo(SignalPhase::kGreen));
  const bool has_vehicles = source.scenario && !source.scenario->vehicles.empty();
  const VehicleOptions usual;
  scene.Add("emission_radius_m",
            (has_vehicles ? source.scenario->vehicles.front() : usual).emission_radius_m);
  scene.AddRaw("sonar",
               SonarJson(has_vehicles ? source.scenario->vehicles.front().profile : PioneerP3dx()));
  if (source.scenario) AddScenario(*source.scenario, &scene);
  return scene.Text();
}

}  // namespace giveway
