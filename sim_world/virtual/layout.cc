#include "sim_world/virtual/layout.h"

#include <algorithm>
#include <numeric>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "sim_world/virtual/due_times.h"

namespace giveway::sim {
namespace {

constexpr double kSlowest_m_s = 0.2;
constexpr double kFastest_m_s = 0.6;
// On top of the free-flow time of the slowest: every vehicle in turn through the tightest place.
constexpr double kSpare_s = 60;
constexpr double kTurn_s = 12;  // where two paths cross; a longer place takes longer

// How far vehicles must hear each other, on either side of the longest section.
double RadioForOneLanes(std::span<const OneLane> lanes) {
  constexpr double kBefore_m = 4;  // both wait outside, and must stop there
  double longest_m = 0;
  for (const OneLane& lane : lanes) {
    longest_m = std::max(longest_m, Norm(lane.to_world - lane.from_world) + lane.width_m);
  }
  return lanes.empty() ? 0 : longest_m + kBefore_m;
}

}  // namespace

Layout::Layout(std::string_view name, const Size& size)
    : dice_(size.seed, size.vehicles), draw_(size.draw) {
  scenario_.name = name;
  scenario_.seed = size.seed;
  scenario_.expect.any_halted = true;
  scenario_.vehicles.reserve(size.vehicles);
}

void Layout::Add(Vec2 start, std::span<const Vec2> waypoints, Vec2 goal) {
  VehicleOptions options;
  options.id = VehicleId{static_cast<std::uint32_t>(scenario_.vehicles.size()) + 1};
  options.profile = PioneerP3dx();
  options.braitenberg = LectureWeights();
  options.cruise_m_s = dice_.Uniform(kSlowest_m_s, kFastest_m_s);
  if (draw_) draw_(&options);
  options.goal = {.set = true, .at_world = goal, .radius_m = 0.1};
  GIVEWAY_CHECK(waypoints.size() <= kMaxWaypoints, waypoints.size());
  for (const Vec2 waypoint : waypoints) {
    options.route.waypoints_world[options.route.count++] = waypoint;
  }
  const Vec2 first = waypoints.empty() ? goal : waypoints.front();
  const Vec2 ahead = first - start;
  options.start_world = {.position_world = start, .heading_rad = Atan2(ahead.y, ahead.x)};
  scenario_.vehicles.push_back(options);
}

void Layout::AddCellToCell(std::uint32_t vehicles, std::uint32_t columns) {
  constexpr double kMoved_m = 0.19;  // so that neighbours stay apart
  const std::vector<std::uint32_t> cells = Shuffled(columns * columns, &dice_);
  const auto place = [&](std::uint32_t cell) {
    return Vec2{kCell_m * (cell % columns) + dice_.Uniform(-kMoved_m, kMoved_m),
                kCell_m * (cell / columns) + dice_.Uniform(-kMoved_m, kMoved_m)};
  };
  for (std::size_t i = 0; i < vehicles; ++i) {
    const Vec2 start = place(cells[2 * i]);
    Add(start, {}, place(cells[2 * i + 1]));
  }
}

void Layout::AddBlock(Vec2 low, Vec2 high) {
  AddWall(low, {high.x, low.y});
  AddWall({high.x, low.y}, high);
  AddWall(high, {low.x, high.y});
  AddWall({low.x, high.y}, low);
}

Scenario Layout::Take(double tightest_m) {
  double slowest_s = 0;
  double turns_s = 0;
  const double radio_m = RadioForOneLanes(scenario_.one_lanes);
  for (VehicleOptions& options : scenario_.vehicles) {
    options.one_lanes = scenario_.one_lanes;
    options.emission_radius_m = std::max(options.emission_radius_m, radio_m);
    slowest_s = std::max(slowest_s, FreeFlowSeconds(options));
    turns_s += std::max(kTurn_s, tightest_m / options.cruise_m_s);
    scenario_.expect.arrived.push_back(options.id);
  }
  scenario_.duration_s = slowest_s + kSpare_s + turns_s;
  return std::move(scenario_);
}

std::vector<std::uint32_t> Shuffled(std::uint32_t count, Random* dice) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::uint32_t left = count; left > 1; --left) {
    std::swap(order[left - 1], order[dice->Next() % left]);
  }
  return order;
}

}  // namespace giveway::sim
