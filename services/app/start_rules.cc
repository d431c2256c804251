#include <fmt/format.h>

#include <algorithm>

#include "services/app/scenario_read.h"

namespace giveway::app {
namespace {

double DistanceToWall(Vec2 point_world, const Wall& wall) {
  const Vec2 along = wall.to_world - wall.from_world;
  const double length2 = SquaredNorm(along);
  if (!(length2 > 0)) return kUnusable;  // refused already
  const double t = std::clamp(Dot(point_world - wall.from_world, along) / length2, 0.0, 1.0);
  return Norm(point_world - (wall.from_world + t * along));
}

void CheckWalls(const VehicleOptions& vehicle, const Section& section,
                const std::vector<Wall>& walls, const std::string& cause) {
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double distance_m = DistanceToWall(vehicle.start_world.position_world, walls[i]);
    if (distance_m <= vehicle.profile.body_radius_m) {
      section.Complain("start",
                       fmt::format("{}the body (radius {} m) overlaps wall[{}], {:.3f} m away",
                                   cause, vehicle.profile.body_radius_m, i, distance_m),
                       "move the start away from the wall");
      return;
    }
  }
}

void CheckGoal(const VehicleOptions& vehicle, const Section& section, const std::string& cause) {
  if (!vehicle.goal.set) return;
  const double distance_m = Norm(vehicle.start_world.position_world - vehicle.goal.at_world);
  if (distance_m <= vehicle.goal.radius_m) {
    section.Complain("start",
                     fmt::format("{}lies inside the vehicle's own goal, {:.3f} m from its centre",
                                 cause, distance_m),
                     "move start and goal apart, or leave the goal out");
  }
}

// The first vehicle before the `index`-th that it overlaps.
void CheckOthers(const ReadScenario& read, std::size_t index, const std::string& cause) {
  const VehicleOptions& mine = read.scenario.vehicles[index];
  for (std::size_t i = 0; i < index; ++i) {
    const VehicleOptions& other = read.scenario.vehicles[i];
    const double needed_m = mine.profile.body_radius_m + other.profile.body_radius_m;
    const double distance_m =
        Norm(mine.start_world.position_world - other.start_world.position_world);
    if (distance_m <= needed_m) {
      read.vehicles[index].Complain(
          "start",
          fmt::format("{}vehicles {} and {} overlap: {:.3f} m between their centres", cause,
                      Number(other.id), Number(mine.id), distance_m),
          fmt::format("move the starts more than {:.3f} m apart", needed_m));
      return;
    }
  }
}

}  // namespace

void CheckStarts(const ReadScenario& read, const std::string& cause) {
  for (std::size_t i = 0; i < read.vehicles.size(); ++i) {
    const VehicleOptions& vehicle = read.scenario.vehicles[i];
    CheckWalls(vehicle, read.vehicles[i], read.scenario.walls, cause);
    CheckGoal(vehicle, read.vehicles[i], cause);
    CheckOthers(read, i, cause);
  }
}

}  // namespace giveway::app
