#include "sim_world/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "services/types/math.h"
#include "sim_world/advancement.h"
#include "sim_world/geometry.h"
#include "sim_world/outline_motion.h"

namespace giveway::sim {
namespace {

struct Gap {
  double metres;
  double rate_m_s;  // negative: closing
};

struct Centre {
  Vec2 position;
  Vec2 velocity;
};

bool IsMoving(const Motion& motion, double from_s) { return motion.stop_s > from_s; }

// The centre at t_s, with the velocity it has between from_s and the next stop.
Centre CentreAt(const Motion& motion, double from_s, double t_s) {
  const Pose pose = PoseAt(motion, t_s);
  if (!IsMoving(motion, from_s)) return {pose.position_world, {}};
  return {pose.position_world, motion.twist.forward_m_s * Forward(pose) + motion.slide_world};
}

// Bound on the centre's acceleration, m/s^2.
double Bend(const Motion& motion, double from_s) {
  if (!IsMoving(motion, from_s)) return 0;
  return std::abs(motion.twist.forward_m_s * motion.twist.turn_rad_s);
}

Gap GapBetween(Vec2 offset, Vec2 velocity, double reach_m) {
  const double distance = Norm(offset);
  const double rate = distance > 0 ? Dot(offset, velocity) / distance : 0;
  return {distance - reach_m, rate};
}

Gap DiscGapAt(const Motion& a, const Motion& b, double from_s, double t_s) {
  const Centre at_a = CentreAt(a, from_s, t_s);
  const Centre at_b = CentreAt(b, from_s, t_s);
  return GapBetween(at_b.position - at_a.position, at_b.velocity - at_a.velocity,
                    a.radius_m + b.radius_m);
}

// The distance to a convex thing is convex, so the centres' rate and bend bound the gap's.
template <typename GapAtTime>
std::optional<double> AdvanceToContact(const GapAtTime& gap_at, double bend_m_s2, double from_s,
                                       double to_s) {
  double t_s = from_s;
  while (t_s <= to_s) {
    const Gap gap = gap_at(t_s);
    const bool touching = gap.metres <= kTouch_m;
    if (touching && gap.rate_m_s < -kSliding_m_s) return t_s;
    t_s += SafeStep(gap.rate_m_s, bend_m_s2, touching ? kSink_m : gap.metres - kTouch_m / 2);
  }
  return std::nullopt;
}

// The smallest gap of a stretch in which neither body starts or stops: where the rate changes sign.
ClosestMoment ClosestOnStretch(const Motion& a, const Motion& b, double from_s, double to_s) {
  const auto moment = [&](double t_s) {
    return ClosestMoment{DiscGapAt(a, b, from_s, t_s).metres, t_s};
  };
  if (DiscGapAt(a, b, from_s, from_s).rate_m_s >= 0) {
    return std::min(moment(from_s), moment(to_s),
                    [](const auto& x, const auto& y) { return x.gap_m < y.gap_m; });
  }
  if (DiscGapAt(a, b, from_s, to_s).rate_m_s <= 0) return moment(to_s);
  double closing_s = from_s;
  double opening_s = to_s;
  for (int i = 0; i < 40; ++i) {
    const double middle_s = (closing_s + opening_s) / 2;
    (DiscGapAt(a, b, from_s, middle_s).rate_m_s < 0 ? closing_s : opening_s) = middle_s;
  }
  return moment(opening_s);
}

bool BothAreDiscs(const Motion& a, const Motion& b) { return !a.IsBox() && !b.IsBox(); }

}  // namespace

Motion StandingAt(const VehicleProfile& profile, const Pose& world_from_body) {
  const bool box = profile.shape == BodyShape::kBox;
  return {.start_world = world_from_body,
          .radius_m = box ? Norm(profile.box_half_m) : profile.body_radius_m,
          .box_half_m = box ? profile.box_half_m : Vec2{}};
}

Pose PoseAt(const Motion& motion, double t_s) {
  const double moved_s = std::min(t_s, motion.stop_s);
  if (motion.slide_world == Vec2{}) return AdvanceArc(motion.start_world, motion.twist, moved_s);
  return {motion.start_world.position_world + moved_s * motion.slide_world,
          motion.start_world.heading_rad};
}

Vec2 PositionAt(const Motion& motion, double t_s) { return PoseAt(motion, t_s).position_world; }

Vec2 TipAt(const Leaf& leaf, double t_s) {
  return leaf.to_world + std::min(t_s, leaf.stop_s) * leaf.to_velocity_world;
}

Outline OutlineAt(const Motion& motion, double t_s) {
  const Pose pose = PoseAt(motion, t_s);
  const Vec2 x_axis = Forward(pose);
  Vec2 velocity;
  double turn = 0;
  if (t_s <= motion.stop_s) {
    velocity = motion.twist.forward_m_s * x_axis + motion.slide_world;
    turn = motion.twist.turn_rad_s;
  }
  Outline outline;
  if (!motion.IsBox()) {
    outline.corner_world[0] = pose.position_world;
    outline.velocity_world[0] = velocity;
    outline.radius_m = motion.radius_m;
    return outline;
  }
  const Vec2 length = motion.box_half_m.x * x_axis;
  const Vec2 width = motion.box_half_m.y * Left(x_axis);
  outline.count = 4;
  const std::array<Vec2, 4> offsets = {length - width, length + width, width - length,
                                       -1 * (length + width)};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    outline.corner_world[i] = pose.position_world + offsets[i];
    outline.velocity_world[i] = velocity + turn * Left(offsets[i]);
  }
  return outline;
}

Outline OutlineAt(const Leaf& leaf, double t_s) {
  Outline outline = {.corner_world = {leaf.from_world, TipAt(leaf, t_s)}, .count = 2};
  if (t_s <= leaf.stop_s) outline.velocity_world[1] = leaf.to_velocity_world;
  return outline;
}

Outline OutlineOf(const Wall& wall) {
  return {.corner_world = {wall.from_world, wall.to_world}, .count = 2};
}

bool Moves(const Motion& motion) {
  return motion.twist.forward_m_s != 0 || motion.slide_world != Vec2{} ||
         (motion.IsBox() && motion.twist.turn_rad_s != 0);
}

bool Moves(const Leaf& leaf) { return leaf.to_velocity_world != Vec2{}; }

double TravelBound(const Motion& motion, double dt_s) {
  if (motion.slide_world == Vec2{}) return std::abs(motion.twist.forward_m_s) * dt_s;
  return Norm(motion.slide_world) * dt_s;
}

double TravelBound(const Leaf& leaf, double dt_s) {
  return Moves(leaf) ? Norm(leaf.to_velocity_world) * dt_s : 0;
}

double GapAt(const Motion& a, const Motion& b, double t_s) {
  if (BothAreDiscs(a, b)) {
    return Norm(PositionAt(a, t_s) - PositionAt(b, t_s)) - a.radius_m - b.radius_m;
  }
  return NearestBetween(OutlineAt(a, t_s), OutlineAt(b, t_s)).gap_m;
}

double GapAt(const Motion& a, const Leaf& leaf, double t_s) {
  return GapAt(a, Wall{leaf.from_world, TipAt(leaf, t_s)}, t_s);
}

double GapAt(const Motion& a, const Wall& wall, double t_s) {
  if (a.IsBox()) return NearestBetween(OutlineAt(a, t_s), OutlineOf(wall)).gap_m;
  const Vec2 centre = PositionAt(a, t_s);
  return Norm(centre - NearestOnSegment(wall.from_world, wall.to_world, centre)) - a.radius_m;
}

std::optional<double> FirstContact(const Motion& a, const Motion& b, double from_s, double to_s) {
  if (!BothAreDiscs(a, b)) return FirstOutlineContact(a, b, from_s, to_s);
  return AdvanceToContact([&](double t_s) { return DiscGapAt(a, b, from_s, t_s); },
                          Bend(a, from_s) + Bend(b, from_s), from_s, to_s);
}

std::optional<double> FirstContact(const Motion& body, const Leaf& leaf, double from_s,
                                   double to_s) {
  const bool stands = !Moves(leaf) || leaf.stop_s <= from_s;
  if (!body.IsBox() && stands) {
    return FirstContact(body, Wall{leaf.from_world, TipAt(leaf, from_s)}, from_s, to_s);
  }
  return FirstOutlineContact(body, leaf, from_s, to_s);
}

std::optional<double> FirstContact(const Motion& body, const Wall& wall, double from_s,
                                   double to_s) {
  if (body.IsBox()) {
    return FirstOutlineContact(body, Leaf{wall.from_world, wall.to_world, {}, 0}, from_s, to_s);
  }
  const auto gap_at = [&](double t_s) {
    const Centre centre = CentreAt(body, from_s, t_s);
    const Vec2 nearest = NearestOnSegment(wall.from_world, wall.to_world, centre.position);
    return GapBetween(centre.position - nearest, centre.velocity, body.radius_m);
  };
  return AdvanceToContact(gap_at, Bend(body, from_s), from_s, to_s);
}

ClosestMoment ClosestWithin(const Motion& a, const Motion& b, double to_s) {
  std::array<double, 4> times = {0, std::min(a.stop_s, to_s), std::min(b.stop_s, to_s), to_s};
  std::sort(times.begin(), times.end());
  ClosestMoment closest = {std::numeric_limits<double>::infinity(), 0};
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    if (times[i] == times[i + 1] && to_s > 0) continue;
    if (!BothAreDiscs(a, b)) {
      closest = SmallerGap(a, b, times[i], times[i + 1], closest);
      continue;
    }
    const ClosestMoment moment = ClosestOnStretch(a, b, times[i], times[i + 1]);
    if (moment.gap_m < closest.gap_m) closest = moment;
  }
  return closest;
}

}  // namespace giveway::sim
