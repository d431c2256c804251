#include "sim_world/geometry/approach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "services/types/math/math.h"
#include "sim_world/geometry/advancement.h"
#include "sim_world/geometry/geometry.h"

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

}  // namespace

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
