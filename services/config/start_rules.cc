#include "services/config/start_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "services/config/start_sweep.h"

namespace giveway {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Everything that stands somewhere at the start, in the order in which the later is blamed.
struct Starts {
  std::vector<StartShape> bodies;  // vehicles, spawn places, obstacles
  std::vector<const Section*> sections;
  std::vector<bool> stands;  // of each body: an obstacle that never moves
  std::vector<StartLine> walls;
  std::vector<StartLine> doors;
};

// What a body overlaps first, by index.
struct Overlaps {
  std::size_t body = kNone;
  std::size_t wall = kNone;
  std::size_t door = kNone;
};

StartShape ShapeOf(const VehicleOptions& vehicle) {
  const RobotModel& profile = vehicle.profile;
  return {profile.shape, vehicle.start_world, profile.body_radius_m, profile.box_half_m};
}

Starts Gather(const ReadScenario& read) {
  Starts starts;
  const auto add = [&starts](const StartShape& shape, const Section& section, bool stands) {
    starts.bodies.push_back(shape);
    starts.sections.push_back(&section);
    starts.stands.push_back(stands);
  };
  const Scenario& scenario = read.scenario;
  for (std::size_t i = 0; i < read.vehicles.size(); ++i) {
    add(ShapeOf(scenario.vehicles[i]), read.vehicles[i], false);
  }
  for (std::size_t i = 0; i < read.spawns.size(); ++i) {
    add(ShapeOf(scenario.spawns[i]), read.spawns[i], false);
  }
  for (std::size_t i = 0; i < read.obstacles.size(); ++i) {
    const Obstacle& o = scenario.obstacles[i];
    add({o.shape, o.start_world, o.radius_m, o.box_half_m}, read.obstacles[i],
        o.waypoints_world.empty());
  }
  for (const Wall& wall : scenario.walls) starts.walls.push_back({wall.from_world, wall.to_world});
  for (const Door& door : scenario.doors) starts.doors.push_back({door.from_world, door.to_world});
  return starts;
}

template <typename T>
std::vector<Bounds> AllBounds(const std::vector<T>& shapes) {
  std::vector<Bounds> bounds;
  for (const T& shape : shapes) bounds.push_back(BoundsOf(shape));
  return bounds;
}

// Of each body the first of each kind it overlaps. What stands for ever may be one thing in several
// bodies, such as an L of two boxes, or be part of a wall. Exact geometry only where that is still
// open: thousands of bodies on one spot are reported as fast as thousands apart.
std::vector<Overlaps> FindOverlaps(const Starts& starts) {
  std::vector<Overlaps> found(starts.bodies.size());
  const auto meet_bodies = [&](std::size_t a, std::size_t b) {
    if (starts.stands[a] && starts.stands[b]) return;
    if (a < found[b].body && Overlap(starts.bodies[a], starts.bodies[b])) found[b].body = a;
  };
  const auto meet_wall = [&](std::size_t body, std::size_t wall) {
    std::size_t& first = found[body].wall;
    if (starts.stands[body]) return;
    if (wall < first && Overlap(starts.bodies[body], starts.walls[wall])) first = wall;
  };
  const auto meet_door = [&](std::size_t body, std::size_t door) {
    std::size_t& first = found[body].door;
    if (door < first && Overlap(starts.bodies[body], starts.doors[door])) first = door;
  };
  const std::vector<Bounds> bodies = AllBounds(starts.bodies);
  Sweep(bodies, AllBounds(starts.walls), {meet_bodies, meet_wall});
  Sweep(bodies, AllBounds(starts.doors), {nullptr, meet_door});
  return found;
}

std::string NameOf(const ReadScenario& read, std::size_t body) {
  const std::size_t vehicles = read.vehicles.size();
  if (body < vehicles) return fmt::format("vehicle {}", Number(read.scenario.vehicles[body].id));
  const std::size_t spawns = read.spawns.size();
  if (body < vehicles + spawns) return fmt::format("spawn[{}]", body - vehicles);
  return fmt::format("obstacle[{}]", body - vehicles - spawns);
}

void AddBodyError(const ReadScenario& read, const Starts& starts, std::size_t body,
                  std::size_t other, const std::string& cause) {
  const auto reach_m = [&](std::size_t i) {
    const StartShape& shape = starts.bodies[i];
    return shape.shape == BodyShape::kBox ? Norm(shape.box_half_m) : shape.radius_m;
  };
  const double distance_m = Norm(starts.bodies[body].world_from_body.position_world -
                                 starts.bodies[other].world_from_body.position_world);
  starts.sections[body]->AddError(
      "start",
      fmt::format("{}{} overlaps {}: {:.3f} m between their centres", cause, NameOf(read, body),
                  NameOf(read, other), distance_m),
      fmt::format("move them apart; {:.3f} m is enough whatever their headings",
                  reach_m(body) + reach_m(other) + 0.001));
}

void AddLineError(const ReadScenario& read, const Starts& starts, std::size_t body,
                  const StartLine& line, const std::string& cause, const std::string& line_name) {
  const double distance_m =
      DistanceToLine(starts.bodies[body].world_from_body.position_world, line);
  starts.sections[body]->AddError("start",
                                  fmt::format("{}{} overlaps {}, {:.3f} m from its centre", cause,
                                              NameOf(read, body), line_name, distance_m),
                                  "move the start away from there");
}

// A leaf that would cut through a wall or another leaf. Meeting at a jamb is what doors do.
void CheckDoors(const ReadScenario& read, const Starts& starts) {
  const auto add_error = [&](std::size_t door, const char* what, std::size_t other) {
    read.doors[door].AddError("to", fmt::format("the leaf crosses {}[{}]", what, other),
                              "let it end at the wall, or move it");
  };
  const auto meet_doors = [&](std::size_t a, std::size_t b) {
    if (Cross(starts.doors[a], starts.doors[b])) add_error(b, "door", a);
  };
  const auto meet_wall = [&](std::size_t door, std::size_t wall) {
    if (Cross(starts.doors[door], starts.walls[wall])) add_error(door, "wall", wall);
  };
  Sweep(AllBounds(starts.doors), AllBounds(starts.walls), {meet_doors, meet_wall});
}

void CheckGoal(const VehicleOptions& vehicle, const Section& section, const std::string& cause) {
  if (!vehicle.goal.set) return;
  const double distance_m = Norm(vehicle.start_world.position_world - vehicle.goal.at_world);
  if (distance_m <= vehicle.goal.radius_m) {
    section.AddError("start",
                     fmt::format("{}lies inside the vehicle's own goal, {:.3f} m from its centre",
                                 cause, distance_m),
                     "move start and goal apart, or leave the goal out");
  }
}

}  // namespace

void CheckStarts(const ReadScenario& read, const std::string& cause) {
  const Starts starts = Gather(read);
  const std::vector<Overlaps> found = FindOverlaps(starts);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto [body, wall, door] = found[i];
    if (body != kNone) AddBodyError(read, starts, i, body, cause);
    if (wall != kNone) {
      AddLineError(read, starts, i, starts.walls[wall], cause, fmt::format("wall[{}]", wall));
    }
    if (door != kNone) {
      AddLineError(read, starts, i, starts.doors[door], cause,
                   fmt::format("the doorway of door[{}]", door));
    }
  }
  CheckDoors(read, starts);
  for (std::size_t i = 0; i < read.vehicles.size(); ++i) {
    CheckGoal(read.scenario.vehicles[i], read.vehicles[i], cause);
  }
  for (std::size_t i = 0; i < read.spawns.size(); ++i) {
    CheckGoal(read.scenario.spawns[i], read.spawns[i], cause);
  }
}

}  // namespace giveway
