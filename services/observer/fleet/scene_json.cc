#include "services/observer/fleet/scene_json.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/observer/fleet/frame_json.h"
#include "services/observer/fleet/sample_format.h"
#include "services/runtime/json.h"

namespace giveway {
namespace {

template <typename Enum>
Json NamesUpTo(Enum last) {
  Json json;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(last); ++i) {
    json.push_back(Name(static_cast<Enum>(i)));
  }
  return json;
}

std::array<double, 2> PointJson(Vec2 point) { return {point.x, point.y}; }

Json SonarJson(const RobotModel& profile) {
  Json object;
  object["half_angle_rad"] = profile.sonar_half_angle_rad;
  object["max_range_m"] = profile.sonar_max_range_m;
  object["mounts"] = JsonArray(profile.sonar, [](const SensorMount& mount) {
    return std::array{mount.position_body.x, mount.position_body.y, mount.bearing_rad};
  });
  return object;
}

Json ObstacleJson(const Obstacle& obstacle) {
  Json object;
  object["at"] = PointJson(obstacle.start_world.position_world);
  object["heading_rad"] = obstacle.start_world.heading_rad;
  if (obstacle.shape == BodyShape::kBox) {
    object["box_half_m"] = PointJson(obstacle.box_half_m);
  } else {
    object["radius_m"] = obstacle.radius_m;
  }
  object["waypoints"] = JsonArray(obstacle.waypoints_world, PointJson);
  return object;
}

Json DoorJson(const Door& door) {
  Json object;
  object["from"] = PointJson(door.from_world);
  object["to"] = PointJson(door.to_world);
  object["closed_s"] = door.closed_s;
  object["open_s"] = door.open_s;
  object["move_s"] = door.move_s;
  object["offset_s"] = door.offset_s;
  return object;
}

Json VehicleJson(const VehicleOptions& vehicle) {
  Json object;
  object["id"] = Number(vehicle.id);
  if (vehicle.profile.shape == BodyShape::kBox) {
    object["box_half_m"] = PointJson(vehicle.profile.box_half_m);
  }
  if (vehicle.goal.set) object["goal"] = PointJson(vehicle.goal.at_world);
  return object;
}

// The one whose emission and sonar the page draws for all: the first vehicle, else the first place,
// without a scenario a usual one.
VehicleOptions CommonVehicle(const std::optional<Scenario>& scenario) {
  if (scenario && !scenario->vehicles.empty()) return scenario->vehicles.front();
  if (scenario && !scenario->spawns.empty()) return scenario->spawns.front();
  VehicleOptions usual;
  usual.profile = PioneerP3dx();
  return usual;
}

void AddScenario(const Scenario& scenario, Json* scene) {
  (*scene)["scenario"] = scenario.name;
  (*scene)["walls"] = JsonArray(scenario.walls, [](const Wall& wall) {
    return std::array{wall.from_world.x, wall.from_world.y, wall.to_world.x, wall.to_world.y};
  });
  (*scene)["one_lanes"] = JsonArray(scenario.one_lanes, [](const OneLane& lane) {
    return std::array{lane.from_world.x, lane.from_world.y, lane.to_world.x, lane.to_world.y,
                      lane.width_m};
  });
  (*scene)["obstacles"] = JsonArray(scenario.obstacles, ObstacleJson);
  (*scene)["doors"] = JsonArray(scenario.doors, DoorJson);
  (*scene)["fleet"] = JsonArray(scenario.vehicles, VehicleJson);
}

}  // namespace

std::string SceneJson(const SceneSource& source) {
  Json scene;
  scene["title"] = source.title;
  if (!source.observer.empty()) scene["observer"] = source.observer;
  scene["columns"] = kVehicleColumns;
  scene["hearings"] = NamesUpTo(Liveness::kLeft);
  scene["modes"] = NamesUpTo(Mode::kLeaving);
  scene["rules"] = NamesUpTo(kLastRule);
  scene["phases"] = NamesUpTo(SignalPhase::kGreen);
  const VehicleOptions common = CommonVehicle(source.scenario);
  scene["emission_radius_m"] = common.emission_radius_m;
  scene["sonar"] = SonarJson(common.profile);
  if (source.scenario) AddScenario(*source.scenario, &scene);
  return JsonText(std::move(scene));
}

}  // namespace giveway
