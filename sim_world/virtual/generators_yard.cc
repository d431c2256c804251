// Places with bays, pallets and ends of walls close to the paths.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"
#include "sim_world/virtual/layout.h"

namespace giveway::sim {
namespace {

constexpr double kParkLane_m = 0.6;  // of the car park, from its middle to either lane's
constexpr double kStand_m = 3.0;     // from its middle to vehicles in bays
constexpr double kBackWall_m = 3.9;
constexpr double kStubs_m = 2.2;  // from its middle to where the walls between bays start
constexpr double kFirstBay_m = 1.5;

Vec2 BayAt(std::uint32_t bay) {
  return {kFirstBay_m + kBay_m * (bay / 2), bay % 2 == 0 ? kStand_m : -kStand_m};
}

void AddBays(std::uint32_t columns, Layout* layout) {
  const double from_x = kFirstBay_m - kBay_m / 2;
  for (const double side : {1.0, -1.0}) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double x = from_x + kBay_m * i;
      layout->AddWall({x, side * kStubs_m}, {x, side * kBackWall_m});
    }
    layout->AddWall({from_x, side * kBackWall_m}, {from_x + kBay_m * columns, side * kBackWall_m});
  }
}

// The smallest distance, shell to segment, from the path of any vehicle, its start and goal
// included; huge without vehicles.
double ShellToRoutes(const Scenario& scenario, Vec2 from, Vec2 to) {
  double least_m = 1e6;
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    const Vec2 start = vehicle.start_world.position_world;
    const Vec2 goal = vehicle.goal.at_world;
    const double turn_a = Cross(goal - start, from - start);
    const double turn_b = Cross(goal - start, to - start);
    const double turn_c = Cross(to - from, start - from);
    const double turn_d = Cross(to - from, goal - from);
    if (turn_a * turn_b < 0 && turn_c * turn_d < 0) return 0;
    const double away_m = std::min({Norm(from - NearestOnSegment(start, goal, from)),
                                    Norm(to - NearestOnSegment(start, goal, to)),
                                    Norm(start - NearestOnSegment(from, to, start)),
                                    Norm(goal - NearestOnSegment(from, to, goal))});
    least_m = std::min(least_m, away_m - vehicle.profile.body_radius_m);
  }
  return least_m;
}

// A static object: a segment, and the distance of its shell round it.
struct Thing {
  Vec2 from;
  Vec2 to;
  double round_m = 0;
};

Thing DrawThing(double side_m, Random* dice) {
  const Vec2 at{dice->Uniform(0, side_m), dice->Uniform(0, side_m)};
  const double angle_rad = dice->Uniform(0, 2 * kPi);
  const double long_m = dice->Uniform(0.4, 1.6);
  const bool post = dice->Next() % 2 == 0;
  if (post) return {at, at, dice->Uniform(0.1, 0.4)};
  return {at, at + long_m * Vec2{Cos(angle_rad), Sin(angle_rad)}, 0};
}

Obstacle Standing(const Thing& thing) {
  Obstacle obstacle;
  obstacle.radius_m = thing.round_m;
  obstacle.start_world = {thing.from, 0};
  return obstacle;
}

// To and fro along x.
Obstacle Walking(double x_m, double side_m) {
  constexpr double kBeyond_m = 2.2;
  Obstacle obstacle;
  obstacle.radius_m = 0.2;
  obstacle.start_world = {{x_m, -kBeyond_m}, 0};
  obstacle.waypoints_world = {{x_m, side_m + kBeyond_m}};
  obstacle.speed_m_s = 0.3;
  return obstacle;
}

}  // namespace

// An aisle with a bay every 2.1 m on both sides and walls between them. From its west end one half
// of the vehicles comes in on the right, each to its bay; half of these bays are taken until the
// one in it has left. The other half leaves its bays for places along the road, on the right
// outside:
//
//      G   G   G  |_|_|_|_|
//   <  .   .   .   .  .  .
//   >  s   s   s   .  .  .
//                 |‾|‾|‾|‾|
Scenario MakeParking(const Size& size) {
  Layout layout("parking", size);
  constexpr double kQueue_m = 2.5;
  constexpr double kRoad_m = -2.0;  // where the aisle's west end is left or reached
  const std::uint32_t coming = (size.vehicles + 1) / 2;
  const std::uint32_t leaving = size.vehicles - coming;
  const std::uint32_t columns = (coming + leaving + 1) / 2;
  AddBays(columns, &layout);
  const auto bays = Shuffled(2 * columns, &layout.Dice());
  const auto places = Shuffled(leaving, &layout.Dice());
  for (std::uint32_t i = 0; i < coming; ++i) {
    const bool taken = i < leaving && layout.Dice().Next() % 2 == 0;
    const Vec2 bay = BayAt(bays[taken ? i : leaving + i]);
    const double start_m = kRoad_m - 1 - kQueue_m * i + layout.Dice().Uniform(-0.2, 0.2);
    const std::array route = {Vec2{kRoad_m + 1, -kParkLane_m}, Vec2{bay.x, -kParkLane_m}};
    layout.Add({start_m, -kParkLane_m}, route, bay);
  }
  for (std::uint32_t i = 0; i < leaving; ++i) {
    const Vec2 bay = BayAt(bays[i]);
    const double place_m = kRoad_m - 2 - kBay_m * places[i];
    const std::array route = {Vec2{bay.x, kParkLane_m}, Vec2{place_m, kParkLane_m}};
    layout.Add(bay, route, {place_m, kParkLane_m + kBeside_m});
  }
  return layout.Take();
}

// The swarm's cells, and between the paths posts and pieces of wall that are as near to a passing
// shell as 0.15 m, most of them 0.15 to 0.5: the nearest of several draws is taken. One obstacle
// moves to and fro along the rim, outside the cells: it stops only on contact, and would run into a
// standing vehicle.
Scenario MakeMixedYard(const Size& size) {
  Layout layout("mixed_yard", size);
  constexpr double kNearest_m = 0.15;
  constexpr double kRim_m = 1.6;
  constexpr int kDraws = 60;
  const auto columns = static_cast<std::uint32_t>(
      std::max(3.0, std::ceil(std::sqrt(20.0 * size.vehicles) / kCell_m)));
  const double side_m = kCell_m * (columns - 1);
  layout.AddCellToCell(size.vehicles, columns);
  const std::uint32_t obstacle_count = 2 + size.vehicles / 2;
  for (std::uint32_t i = 0; i < obstacle_count; ++i) {
    double best_m = 1e6;
    Thing best;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Thing thing = DrawThing(side_m, &layout.Dice());
      const double away_m = ShellToRoutes(layout.SoFar(), thing.from, thing.to) - thing.round_m;
      if (away_m < kNearest_m || away_m >= best_m) continue;
      best_m = away_m;
      best = thing;
    }
    if (best_m >= 1e6) continue;
    if (best.round_m == 0) {
      layout.AddWall(best.from, best.to);
    } else {
      layout.AddObstacle(Standing(best));
    }
  }
  layout.AddObstacle(Walking(-kRim_m, side_m));
  return layout.Take();
}

}  // namespace giveway::sim
