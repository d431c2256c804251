// Open fields in which many vehicles need the same space: the middle of a circle, or the same goal.
#include <algorithm>
#include <cmath>
#include <vector>

#include "services/types/math/math.h"
#include "sim_world/virtual/layout.h"

namespace giveway::sim {
namespace {

constexpr double kApart_m = 2.2;  // between neighbours on the circle

Vec2 OnCircle(double radius_m, double angle_rad) {
  return {radius_m * Cos(angle_rad), radius_m * Sin(angle_rad)};
}

}  // namespace

// All paths cross in one point. A vehicle on its goal stands where another has started: it
// obstructs none once that one has left.
Scenario MakeAntipodal(const Size& size) {
  Layout layout("antipodal", size);
  constexpr double kLeast_m = 4;
  constexpr double kMoved_m = 0.05;
  const double radius_m = std::max(kLeast_m, kApart_m * size.vehicles / (2 * kPi));
  const double turned_rad = layout.Dice().Uniform(0, 2 * kPi);
  for (std::uint32_t i = 0; i < size.vehicles; ++i) {
    const double angle_rad = turned_rad + 2 * kPi * i / size.vehicles;
    const double start_m = radius_m + layout.Dice().Uniform(-kMoved_m, kMoved_m);
    layout.Add(OnCircle(start_m, angle_rad), {}, OnCircle(radius_m, angle_rad + kPi));
  }
  return layout.Take();
}

// Cells as in the swarm; two vehicles share a goal, and the last three if their number is odd.
// Which of them arrives is open; the others can only stand near.
Scenario MakeSharedGoal(const Size& size) {
  Layout layout("shared_goal", size);
  constexpr double kMoved_m = 0.19;
  const double side_m = std::sqrt(16.0 * size.vehicles);
  const std::uint32_t groups = size.vehicles / 2;
  const auto columns = static_cast<std::uint32_t>(
      std::max(side_m / kCell_m, std::ceil(std::sqrt(size.vehicles + groups))));
  const std::vector<std::uint32_t> cells = Shuffled(columns * columns, &layout.Dice());
  const auto place = [&](std::uint32_t cell) {
    return Vec2{kCell_m * (cell % columns) + layout.Dice().Uniform(-kMoved_m, kMoved_m),
                kCell_m * (cell / columns) + layout.Dice().Uniform(-kMoved_m, kMoved_m)};
  };
  std::vector<Vec2> goals;
  for (std::uint32_t i = 0; i < groups; ++i) goals.push_back(place(cells[size.vehicles + i]));
  for (std::uint32_t i = 0; i < size.vehicles; ++i) {
    layout.Add(place(cells[i]), {}, goals[std::min(i / 2, groups - 1)]);
  }
  Scenario scenario = layout.Take();
  scenario.expect.arrived.clear();
  scenario.expect.any_arrived = true;
  return scenario;
}

}  // namespace giveway::sim
