// What the generators share: a scenario under construction, to which vehicles are added one by one.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "services/types/math/random.h"
#include "services/types/scenario.h"

namespace giveway::sim {

// The smallest distance between two starts and between two goals, centre to centre.
inline constexpr double kRoom_m = 2.0;

// The edge of a cell of Layout::AddCellToCell.
inline constexpr double kCell_m = 2.4;

// Changes the robot that a generator is about to add: body, drive, cruise speed. Its route is not
// known yet.
using RobotDraw = std::function<void(VehicleOptions* options)>;

struct Size {
  std::uint32_t vehicles = 6;  // 2 to 1000
  std::uint32_t seed = 1;
  RobotDraw draw{};  // empty: Pioneers at 0.2 to 0.6 m/s
};

class Layout {
 public:
  Layout(std::string_view name, const Size& size);

  Random& Dice() { return dice_; }
  const Scenario& SoFar() const { return scenario_; }
  // Adds the next vehicle: it stands at `start`, faces the first point of its route, passes
  // `waypoints` and ends at `goal`. Its cruise speed is drawn, and further properties by
  // Size::draw.
  void Add(Vec2 start, std::span<const Vec2> waypoints, Vec2 goal);
  // Adds that many vehicles, each from a cell of a square grid to another, both its own; the places
  // are moved a little within their cells. columns * columns is at least twice the vehicles.
  void AddCellToCell(std::uint32_t vehicles, std::uint32_t columns);
  void AddObstacle(const Obstacle& obstacle) { scenario_.obstacles.push_back(obstacle); }
  void AddWall(Vec2 from, Vec2 to) { scenario_.walls.push_back({from, to}); }
  void AddOneLane(const OneLane& lane) { scenario_.one_lanes.push_back(lane); }
  // Four walls round a rectangle along the axes.
  void AddBlock(Vec2 low, Vec2 high);

  // Sets what depends on all vehicles: duration and expectation. `tightest_m` is the length of the
  // tightest place, which in the worst case they pass one by one.
  Scenario Take(double tightest_m = 0);

 private:
  Random dice_;
  RobotDraw draw_;
  Scenario scenario_;
};

// Where vehicles that have passed park: next to a lane, so that they obstruct none. There is space
// between two bays.
inline constexpr double kBay_m = 2.1;     // along the lane
inline constexpr double kBeside_m = 1.6;  // from the lane's middle

// Before and behind a passage, where only one is either, together.
inline constexpr double kMouths_m = 3;

// A random order of 0, 1, … count - 1.
std::vector<std::uint32_t> Shuffled(std::uint32_t count, Random* dice);

}  // namespace giveway::sim
