#include "sim_world/geometry/outline.h"

#include <algorithm>
#include <limits>

#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"

namespace giveway::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Corners nearer than this give no direction that rounding has not corrupted.
constexpr double kNoDirection_m = 1e-9;
// Corners this much behind the foremost belong to the same side: less than what contacts are
// found to, more than rounding.
constexpr double kSameSide_m = 1e-8;

struct Range {
  double low = kInfinity;
  double high = -kInfinity;

  void Include(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

Range Along(const Outline& outline, Vec2 axis) {
  Range range;
  for (std::size_t i = 0; i < outline.count; ++i) range.Include(Dot(axis, outline.corner_world[i]));
  return range;
}

struct Separating {
  double apart_m = -kInfinity;
  Vec2 axis_world;  // from the outline whose side it is to the other

  void Keep(double apart, Vec2 axis) {
    if (apart <= apart_m) return;
    apart_m = apart;
    axis_world = axis;
  }
};

// The best of the directions normal to the sides of `a`; a segment has two sides and two ends.
Separating OnSidesOf(const Outline& a, const Outline& b) {
  Separating best;
  if (a.count == 1) return best;
  for (std::size_t i = 0; i < a.count; ++i) {
    const Vec2 side = a.corner_world[(i + 1) % a.count] - a.corner_world[i];
    const double length = Norm(side);
    if (length <= 0) continue;
    const Vec2 along = (1 / length) * side;
    const Vec2 outward = {along.y, -along.x};
    best.Keep(Along(b, outward).low - Dot(outward, a.corner_world[i]), outward);
    if (a.count == 2) best.Keep(Along(b, along).low - Along(a, along).high, along);
  }
  return best;
}

// The shortest connection between two cores that do not overlap.
struct Shortest {
  double squared_m2 = kInfinity;
  Vec2 from_a_world;
  Vec2 to_b_world;

  void Keep(Vec2 on_a, Vec2 on_b) {
    const double squared = SquaredNorm(on_b - on_a);
    if (squared < squared_m2) *this = {squared, on_a, on_b};
  }
};

// One of the nearest points is a corner.
Shortest ShortestBetween(const Outline& a, const Outline& b) {
  Shortest shortest;
  const auto keep_sides = [](const Outline& sides, const Outline& corners, const auto& keep) {
    for (std::size_t i = 0; i < sides.count; ++i) {
      const Vec2 from = sides.corner_world[i];
      const Vec2 to = sides.corner_world[(i + 1) % sides.count];
      for (std::size_t j = 0; j < corners.count; ++j) {
        const Vec2 corner = corners.corner_world[j];
        keep(NearestOnSegment(from, to, corner), corner);
      }
    }
  };
  keep_sides(a, b, [&](Vec2 on_side, Vec2 corner) { shortest.Keep(on_side, corner); });
  keep_sides(b, a, [&](Vec2 on_side, Vec2 corner) { shortest.Keep(corner, on_side); });
  return shortest;
}

// The normal speed along the part of the shell that is foremost in one direction: linear in the
// place across, between two corners.
struct Front {
  Range across;             // where it starts and ends
  double speed_at_low = 0;  // m/s along the axis
  double speed_at_high = 0;

  double SpeedAt(double place) const {
    const double width = across.high - across.low;
    if (width <= 0) return speed_at_low;
    const double share = std::clamp((place - across.low) / width, 0.0, 1.0);
    return speed_at_low + share * (speed_at_high - speed_at_low);
  }
};

// Foremost along `facing`; speeds along `axis`.
Front FrontOf(const Outline& outline, Vec2 facing, Vec2 axis) {
  const double foremost = Along(outline, facing).high;
  Front front;
  for (std::size_t i = 0; i < outline.count; ++i) {
    const Vec2 corner = outline.corner_world[i];
    if (Dot(facing, corner) < foremost - kSameSide_m) continue;
    const double across = Cross(axis, corner);
    const double speed = Dot(axis, outline.velocity_world[i]);
    if (across < front.across.low) front.speed_at_low = speed;
    if (across > front.across.high) front.speed_at_high = speed;
    front.across.Include(across);
  }
  return front;
}

}  // namespace

Nearest NearestBetween(const Outline& a, const Outline& b) {
  Separating best = OnSidesOf(a, b);
  const Separating of_b = OnSidesOf(b, a);
  best.Keep(of_b.apart_m, -1 * of_b.axis_world);
  const Shortest shortest = ShortestBetween(a, b);
  const double distance = Sqrt(shortest.squared_m2);
  // If a side is nearest, its own direction is exact; that of the connection is only as accurate as
  // it is long. Two corners are nearest if their distance is greater than any side shows.
  const bool corners = best.apart_m > 0 && distance > best.apart_m + kNoDirection_m;
  const bool discs = best.apart_m == -kInfinity;
  Nearest nearest = {best.apart_m, best.axis_world, {}};
  if (corners || (discs && distance > kNoDirection_m)) {
    nearest = {distance, (1 / distance) * (shortest.to_b_world - shortest.from_a_world), {}};
  } else if (discs) {
    nearest = {distance, {1, 0}, {}};  // one place: any direction is as good
  }
  nearest.gap_m -= a.radius_m + b.radius_m;
  nearest.on_b_world = shortest.to_b_world - b.radius_m * nearest.axis_world;
  return nearest;
}

double GapRate(const Outline& a, const Outline& b, const Nearest& nearest) {
  const Vec2 axis = nearest.axis_world;
  const Front of_a = FrontOf(a, axis, axis);
  const Front of_b = FrontOf(b, -1 * axis, axis);
  const double low = std::max(of_a.across.low, of_b.across.low);
  const double high = std::min(of_a.across.high, of_b.across.high);
  const auto rate_at = [&](double place) { return of_b.SpeedAt(place) - of_a.SpeedAt(place); };
  return low <= high ? std::min(rate_at(low), rate_at(high)) : rate_at((low + high) / 2);
}

}  // namespace giveway::sim
