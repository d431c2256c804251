#include "services/config/start_sweep.h"

#include <algorithm>
#include <cmath>

namespace giveway {
namespace {

// Bounds with x and y exchanged where the sweep goes along y.
struct Item {
  Bounds bounds;
  std::size_t index = 0;
  bool is_line = false;
};

bool IsFinite(const Bounds& b) {
  return std::isfinite(b.low_world.x + b.low_world.y + b.high_world.x + b.high_world.y);
}

Vec2 Exchanged(Vec2 v) { return {v.y, v.x}; }

// Along the axis on which the bodies spread more: there the fewest are met at a time.
bool SpreadAlongY(const std::vector<Item>& bodies) {
  if (bodies.empty()) return false;
  Vec2 low = bodies.front().bounds.low_world;
  Vec2 high = low;
  for (const Item& body : bodies) {
    const Vec2 at = body.bounds.low_world;
    low = {std::min(low.x, at.x), std::min(low.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
  }
  return high.y - low.y > high.x - low.x;
}

std::vector<Item> SortedItems(const std::vector<Bounds>& bodies, const std::vector<Bounds>& lines) {
  std::vector<Item> items;
  const auto add = [&items](const std::vector<Bounds>& all, bool is_line) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (IsFinite(all[i])) items.push_back({all[i], i, is_line});
    }
  };
  add(bodies, false);
  const bool along_y = SpreadAlongY(items);
  add(lines, true);
  for (Item& item : items) {
    if (along_y)
      item.bounds = {Exchanged(item.bounds.low_world), Exchanged(item.bounds.high_world)};
  }
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.bounds.low_world.x < b.bounds.low_world.x;
  });
  return items;
}

// Calls `meet` with each of the open items that reaches as far as `item` starts and overlaps it
// across the sweep; drops those that ended before.
template <typename Meet>
void MeetOpen(std::vector<Item>* open, const Item& item, Meet&& meet) {
  const Bounds& mine = item.bounds;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < open->size(); ++i) {
    const Bounds& other = (*open)[i].bounds;
    if (other.high_world.x < mine.low_world.x) continue;
    if (other.low_world.y <= mine.high_world.y && mine.low_world.y <= other.high_world.y) {
      meet((*open)[i].index);
    }
    if (kept != i) (*open)[kept] = (*open)[i];
    ++kept;
  }
  open->resize(kept);
}

}  // namespace

void Sweep(const std::vector<Bounds>& bodies, const std::vector<Bounds>& lines,
           const SweepPairs& visit) {
  std::vector<Item> open_bodies;
  std::vector<Item> open_lines;
  for (const Item& item : SortedItems(bodies, lines)) {
    if (item.is_line) {
      MeetOpen(&open_bodies, item,
               [&](std::size_t body) { visit.body_and_line(body, item.index); });
      open_lines.push_back(item);
      continue;
    }
    if (visit.bodies) {
      MeetOpen(&open_bodies, item, [&](std::size_t other) {
        visit.bodies(std::min(item.index, other), std::max(item.index, other));
      });
    }
    MeetOpen(&open_lines, item, [&](std::size_t line) { visit.body_and_line(item.index, line); });
    open_bodies.push_back(item);
  }
}

}  // namespace giveway
