#include "services/vehicle/decision/detour.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>

#include "services/types/math/math.h"

namespace giveway {
namespace {

// Cells of the map, 10.25 m a side with this vehicle in the middle one.
constexpr int kHalf = 20;
constexpr int kSide = 2 * kHalf + 1;
constexpr int kCells = kSide * kSide;
constexpr double kCell_m = 0.25;
constexpr double kNever = 1e9;  // more than any path across the map costs
// Inside a keep-out, but without contact of the bodies: expensive, only for leaving it.
constexpr double kScrape = 0.9;
constexpr double kScrapeCost = 8;

using Cost = std::array<double, kCells>;

struct Step {
  int dx, dy;
  double length;
};
constexpr std::array<Step, 8> kSteps = {{{1, 0, 1},
                                         {0, 1, 1},
                                         {-1, 0, 1},
                                         {0, -1, 1},
                                         {1, 1, std::numbers::sqrt2},
                                         {-1, 1, std::numbers::sqrt2},
                                         {-1, -1, std::numbers::sqrt2},
                                         {1, -1, std::numbers::sqrt2}}};

constexpr int Index(int column, int row) { return row * kSide + column; }

Vec2 CentreOf(int cell, Vec2 from_world) {
  return from_world + kCell_m * Vec2{static_cast<double>(cell % kSide - kHalf),
                                     static_cast<double>(cell / kSide - kHalf)};
}

// What each cell costs to drive over, relative to free ground.
Cost CostOf(Vec2 from_world, std::span<const KeepOut> discs) {
  Cost cost;
  cost.fill(1);
  for (const KeepOut& disc : discs) {
    const Vec2 offset = disc.centre_world - from_world;
    const auto bounds = [&](double middle) {
      const double low = std::clamp((middle - disc.radius_m) / kCell_m, -1.0 * kHalf, 1.0 * kHalf);
      const double high = std::clamp((middle + disc.radius_m) / kCell_m, -1.0 * kHalf, 1.0 * kHalf);
      return std::pair(static_cast<int>(low + kHalf), static_cast<int>(high + kHalf));
    };
    const auto [left, right] = bounds(offset.x);
    const auto [bottom, top] = bounds(offset.y);
    for (int row = bottom; row <= top; ++row) {
      for (int column = left; column <= right; ++column) {
        const int cell = Index(column, row);
        const double apart = Norm(CentreOf(cell, from_world) - disc.centre_world);
        const auto at = static_cast<std::size_t>(cell);
        if (apart < kScrape * disc.radius_m) {
          cost[at] = kNever;
        } else if (apart < disc.radius_m) {
          cost[at] = std::max(cost[at], kScrapeCost);
        }
      }
    }
  }
  return cost;
}

// The cell nearest to the target; of a target beyond the map the cell on its edge towards it.
int CellTowards(Vec2 offset) {
  const double longest = std::max({1e-9, std::max(offset.x, -offset.x) / (kHalf * kCell_m),
                                   std::max(offset.y, -offset.y) / (kHalf * kCell_m)});
  const Vec2 inside = longest > 1 ? (1 / longest) * offset : offset;
  return Index(static_cast<int>(inside.x / kCell_m + kHalf + 0.5),
               static_cast<int>(inside.y / kCell_m + kHalf + 0.5));
}

struct Open {
  double total;
  int cell;
};

// A* from the middle of the map; parents of the cells on the path, -1 where unreached.
class Search {
 public:
  Search(const Cost& cost, int goal) : cost_(cost), goal_(goal) {
    reached_.fill(kNever);
    parents_.fill(-1);
    Reach(Index(kHalf, kHalf), -1, 0);
  }

  void Run() {
    while (count_ > 0) {
      std::pop_heap(open_.begin(), open_.begin() + count_, Later);
      const Open next = open_[static_cast<std::size_t>(--count_)];
      if (Left(next.cell) < Left(nearest_)) nearest_ = next.cell;
      if (next.cell == goal_) return;
      const double reached = reached_[static_cast<std::size_t>(next.cell)];
      if (next.total > reached + Left(next.cell) + 1e-9) continue;  // an older, longer path
      for (const Step& step : kSteps) Try(next.cell, step, reached);
    }
  }
  // The goal, or the cell nearest to it of all that can be reached.
  int Nearest() const { return nearest_; }
  int Parent(int cell) const { return parents_[static_cast<std::size_t>(cell)]; }

 private:
  // The first of two equal totals is the lower cell: the same on every machine.
  static bool Later(const Open& a, const Open& b) {
    return a.total != b.total ? a.total > b.total : a.cell > b.cell;
  }
  double Left(int cell) const {
    const int dx = cell % kSide - goal_ % kSide;
    const int dy = cell / kSide - goal_ / kSide;
    return Sqrt(static_cast<double>(dx * dx + dy * dy));
  }
  void Reach(int cell, int parent, double length) {
    if (count_ == static_cast<int>(open_.size())) return;
    reached_[static_cast<std::size_t>(cell)] = length;
    parents_[static_cast<std::size_t>(cell)] = parent;
    open_[static_cast<std::size_t>(count_++)] = {length + Left(cell), cell};
    std::push_heap(open_.begin(), open_.begin() + count_, Later);
  }
  void Try(int cell, const Step& step, double reached) {
    const int column = cell % kSide + step.dx;
    const int row = cell / kSide + step.dy;
    if (column < 0 || column >= kSide || row < 0 || row >= kSide) return;
    const int next = Index(column, row);
    const double length = reached + step.length * cost_[static_cast<std::size_t>(next)];
    if (length < kNever && length < reached_[static_cast<std::size_t>(next)]) {
      Reach(next, cell, length);
    }
  }

  const Cost& cost_;
  const int goal_;
  int nearest_ = Index(kHalf, kHalf);
  Cost reached_;
  std::array<int, kCells> parents_;
  std::array<Open, std::size_t{2} * kCells> open_;
  int count_ = 0;
};

bool InSight(Vec2 from, Vec2 to, std::span<const KeepOut> discs) {
  const Vec2 displacement = to - from;
  const double squared = SquaredNorm(displacement);
  return std::none_of(discs.begin(), discs.end(), [&](const KeepOut& disc) {
    const Vec2 away = from - disc.centre_world;
    if (SquaredNorm(away) < disc.radius_m * disc.radius_m) return Dot(away, displacement) < 0;
    const double at =
        squared > 0 ? std::clamp(Dot(disc.centre_world - from, displacement) / squared, 0.0, 1.0)
                    : 0;
    return Norm(from + at * displacement - disc.centre_world) < kScrape * disc.radius_m;
  });
}

}  // namespace

std::optional<Vec2> FirstTurn(Vec2 from_world, Vec2 to_world, std::span<const KeepOut> discs) {
  const Cost cost = CostOf(from_world, discs);
  const int goal = CellTowards(to_world - from_world);
  Search search(cost, goal);
  search.Run();
  int cell = search.Nearest();
  if (search.Parent(cell) < 0) return std::nullopt;
  while (search.Parent(search.Parent(cell)) >= 0 &&
         !InSight(from_world, CentreOf(cell, from_world), discs)) {
    cell = search.Parent(cell);
  }
  return CentreOf(cell, from_world);
}

}  // namespace giveway
