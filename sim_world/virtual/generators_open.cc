// Layouts without walls in which every vehicle drives straight to the goal.
#include <algorithm>
#include <cmath>

#include "services/types/math/math.h"
#include "sim_world/virtual/layout.h"

namespace giveway::sim {
namespace {

constexpr double kRoadLane_m = 1.0;   // from a road's middle to the middle of its right lane
constexpr double kLaneQueue_m = 2.5;  // between vehicles of one lane
constexpr double kParked_m = 2.1;     // between goals of one lane

}  // namespace

// Four roads with two lanes each meet at the origin; traffic keeps to the right:
//
//              | v  ^ |          Each of the four streams has a lane of its own. Those waiting
//        ------+      +------    stand behind each other before the crossing; beyond it they park
//        <                 <     in their lane in the same order, the first the farthest, so that
//        >                 >     none blocks a later one.
//        ------+      +------
//              | v  ^ |
Scenario MakeCrossing(const Size& size) {
  Layout layout("crossing", size);
  constexpr double kBefore_m = 4;
  const std::uint32_t in_lane = (size.vehicles + 3) / 4;
  for (std::uint32_t i = 0; i < size.vehicles; ++i) {
    const std::uint32_t place = i / 4;
    const double heading = kPi / 2 * (i % 4);
    const Vec2 along{Cos(heading), Sin(heading)};
    const Vec2 lane = -kRoadLane_m * Left(along);
    const double start_m = kBefore_m + kLaneQueue_m * place + layout.Dice().Uniform(-0.2, 0.2);
    const double goal_m = kBefore_m + kParked_m * (in_lane - 1 - place);
    layout.Add(lane - start_m * along, {}, lane + goal_m * along);
  }
  return layout.Take();
}

// A square of 16 m^2 per vehicle, cut into cells; every vehicle has one cell to start in and one to
// end in, shared with no other, and is offset a little within it. Paths cross anywhere.
Scenario MakeSwarm(const Size& size) {
  Layout layout("swarm", size);
  const double side_m = std::sqrt(16.0 * size.vehicles);
  const auto columns = static_cast<std::uint32_t>(
      std::max(side_m / kCell_m, std::ceil(std::sqrt(2.0 * size.vehicles))));
  layout.AddCellToCell(size.vehicles, columns);
  return layout.Take();
}

// One lane; the speeds are drawn, so that the faster close up on the slower. Goals are as far on as
// the queue is long, in the same order: the first parks the farthest.
Scenario MakeConvoy(const Size& size) {
  Layout layout("convoy", size);
  constexpr double kWay_m = 12;
  for (std::uint32_t i = 0; i < size.vehicles; ++i) {
    const double start_m = -kLaneQueue_m * i + layout.Dice().Uniform(-0.2, 0.2);
    layout.Add({start_m, 0}, {}, {kWay_m - kLaneQueue_m * i, 0});
  }
  return layout.Take();
}

}  // namespace giveway::sim
