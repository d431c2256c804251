// What the generators share: a scenario under construction, with vehicles put in one by one.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "services/types/random.h"
#include "services/types/scenario.h"
#include "sim_world/virtual/generators.h"

namespace giveway::sim {

class Layout {
 public:
  Layout(std::string_view name, Size size);

  Random& Dice() { return dice_; }
  // The next vehicle: it stands at `start`, looks at the first point of its way, passes
  // `waypoints` and ends at `goal`. Its cruise speed is drawn.
  void Add(Vec2 start, std::span<const Vec2> waypoints, Vec2 goal);
  void AddWall(Vec2 from, Vec2 to) { scenario_.walls.push_back({from, to}); }
  // Four walls round a rectangle along the axes.
  void AddBlock(Vec2 low, Vec2 high);

  // Sets what follows from the whole: duration and expectation. `tightest_m` is the length of the
  // tightest place, which in the worst case they pass one by one.
  Scenario Take(double tightest_m = 0);

 private:
  Random dice_;
  Scenario scenario_;
};

// Where those who go by park: beside a lane, so that they are in nobody's way. Between two bays
// there is room.
inline constexpr double kBay_m = 2.1;     // along the lane
inline constexpr double kBeside_m = 1.6;  // from the lane's middle

// A random order of 0, 1, … count - 1.
std::vector<std::uint32_t> Shuffled(std::uint32_t count, Random* dice);

}  // namespace giveway::sim
