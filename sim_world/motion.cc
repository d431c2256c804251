#include "sim_world/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "services/types/math.h"
#include "sim_world/geometry.h"

namespace giveway::sim {
namespace {

// Below this closing speed touching shells are taken as sliding: rounding must not lock a body that
// drives along a wall.
constexpr double kSliding_m_s = 1e-9;
// What a touching, not closing body may sink in before its motion is looked at again.
constexpr double kSink_m = 1e-8;

struct Gap {
  double metres;
  double rate_m_s;  // negative: closing
};

struct Centre {
  Vec2 position;
  Vec2 velocity;
};

bool Moves(const Motion& motion, double from_s) { return motion.stop_s > from_s; }

// The centre at t_s, with the velocity it has between from_s and the next stop.
Centre CentreAt(const Motion& motion, double from_s, double t_s) {
  const Pose pose = AdvanceArc(motion.start_world, motion.twist, std::min(t_s, motion.stop_s));
  if (!Moves(motion, from_s)) return {pose.position_world, {}};
  return {pose.position_world, motion.twist.forward_m_s * Forward(pose)};
}

// Bound on the centre's acceleration, m/s^2.
double Bend(const Motion& motion, double from_s) {
  if (!Moves(motion, from_s)) return 0;
  return std::abs(motion.twist.forward_m_s * motion.twist.turn_rad_s);
}

Gap GapBetween(Vec2 offset, Vec2 velocity, double reach_m) {
  const double distance = Norm(offset);
  const double rate = distance > 0 ? Dot(offset, velocity) / distance : 0;
  return {distance - reach_m, rate};
}

Gap GapAt(const Motion& a, const Motion& b, double from_s, double t_s) {
  const Centre at_a = CentreAt(a, from_s, t_s);
  const Centre at_b = CentreAt(b, from_s, t_s);
  return GapBetween(at_b.position - at_a.position, at_b.velocity - at_a.velocity,
                    a.radius_m + b.radius_m);
}

// Conservative advancement. The distance to a convex thing is convex, so over a step d the gap
// stays above gap + rate d - bend d^2 / 2; this is the d at which that bound has fallen by `fall`.
double SafeStep(double rate_m_s, double bend_m_s2, double fall_m) {
  if (bend_m_s2 > 0) {
    const double root = Sqrt(rate_m_s * rate_m_s + 2 * bend_m_s2 * fall_m);
    // Two forms of the same root; each avoids cancellation on its side.
    return rate_m_s > 0 ? (rate_m_s + root) / bend_m_s2 : 2 * fall_m / (root - rate_m_s);
  }
  return rate_m_s < 0 ? fall_m / -rate_m_s : std::numeric_limits<double>::infinity();
}

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
    return ClosestMoment{GapAt(a, b, from_s, t_s).metres, t_s};
  };
  if (GapAt(a, b, from_s, from_s).rate_m_s >= 0) {
    return std::min(moment(from_s), moment(to_s),
                    [](const auto& x, const auto& y) { return x.gap_m < y.gap_m; });
  }
  if (GapAt(a, b, from_s, to_s).rate_m_s <= 0) return moment(to_s);
  double closing_s = from_s;
  double opening_s = to_s;
  for (int i = 0; i < 40; ++i) {
    const double middle_s = (closing_s + opening_s) / 2;
    (GapAt(a, b, from_s, middle_s).rate_m_s < 0 ? closing_s : opening_s) = middle_s;
  }
  return moment(opening_s);
}

}  // namespace

Vec2 PositionAt(const Motion& motion, double t_s) {
  return AdvanceArc(motion.start_world, motion.twist, std::min(t_s, motion.stop_s)).position_world;
}

std::optional<double> FirstContact(const Motion& a, const Motion& b, double from_s, double to_s) {
  return AdvanceToContact([&](double t_s) { return GapAt(a, b, from_s, t_s); },
                          Bend(a, from_s) + Bend(b, from_s), from_s, to_s);
}

std::optional<double> FirstContact(const Motion& body, const Wall& wall, double from_s,
                                   double to_s) {
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
    const ClosestMoment moment = ClosestOnStretch(a, b, times[i], times[i + 1]);
    if (moment.gap_m < closest.gap_m) closest = moment;
  }
  return closest;
}

}  // namespace giveway::sim
