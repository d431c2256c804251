#include "sim_world/geometry/outline_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim_world/geometry/advancement.h"

namespace giveway::sim {
namespace {

// The shortest step of touching outlines: in it they cannot sink in by more than kTouch_m.
constexpr double kShortestStep_s = 1e-7;

// What holds for all corners over a stretch of time in which the motion neither starts nor stops.
struct Bounds {
  double speed_m_s = 0;
  double bend_m_s2 = 0;   // acceleration
  double turn_rad_s = 0;  // of the outline, constant; 0 for a disc, whose turning shows nowhere
};

Bounds BoundsOf(const Motion& motion, double from_s) {
  if (motion.stop_s <= from_s) return {};
  const double forward = std::abs(motion.twist.forward_m_s);
  const double turn = std::abs(motion.twist.turn_rad_s);
  const double slide = Norm(motion.slide_world);
  if (!motion.IsBox()) return {forward + slide, forward * turn, 0};
  const double reach_m = Norm(motion.box_half_m);
  return {forward + slide + turn * reach_m, forward * turn + turn * turn * reach_m,
          motion.twist.turn_rad_s};
}

Bounds BoundsOf(const Leaf& leaf, double from_s) {
  if (leaf.stop_s <= from_s) return {};
  return {Norm(leaf.to_velocity_world), 0, 0};
}

void StandStill(Outline* outline) { outline->velocity_world = {}; }

// Two things over a stretch of time in which neither starts nor stops.
template <typename A, typename B>
class Stretch {
 public:
  Stretch(const A& a, const B& b, double from_s, double to_s)
      : a_(a),
        b_(b),
        of_a_(BoundsOf(a, from_s)),
        of_b_(BoundsOf(b, from_s)),
        to_s_(to_s),
        a_stands_(a.stop_s <= from_s),
        b_stands_(b.stop_s <= from_s) {}

  void EvaluateAt(double t_s) {
    t_s_ = t_s;
    at_a_ = OutlineAt(a_, t_s);
    at_b_ = OutlineAt(b_, t_s);
    if (a_stands_) StandStill(&at_a_);
    if (b_stands_) StandStill(&at_b_);
    nearest_ = NearestBetween(at_a_, at_b_);
  }
  double Gap() const { return nearest_.gap_m; }
  double Rate() const { return GapRate(at_a_, at_b_, nearest_); }

  // How long from now on the gap certainly stays above `floor_m`. A direction in which the two are
  // further apart proves it, and may turn with either of them: if it turns with the outline whose
  // side it is normal to, the other's corners give the bound.
  double SafeUntil(double floor_m) const {
    const double with_a = SafeAlongTurning(of_a_.turn_rad_s, floor_m);
    if (of_a_.turn_rad_s == of_b_.turn_rad_s) return with_a;
    return std::max(with_a, SafeAlongTurning(of_b_.turn_rad_s, floor_m));
  }

 private:
  // Each corner's place along the axis, from each of the other's corners: known value, known rate
  // and a bounded bend. An axis that turns at w adds 2 w times the speed and w^2 times the
  // distance.
  double SafeAlongTurning(double turn_rad_s, double floor_m) const {
    const Vec2 axis = nearest_.axis_world;
    const Vec2 axis_rate = turn_rad_s * Left(axis);
    const double radii_m = at_a_.radius_m + at_b_.radius_m;
    const double bend = Bend(turn_rad_s);
    double safe_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < at_a_.count; ++i) {
      for (std::size_t j = 0; j < at_b_.count; ++j) {
        const Vec2 displacement = at_b_.corner_world[j] - at_a_.corner_world[i];
        const double rate = Dot(axis, at_b_.velocity_world[j] - at_a_.velocity_world[i]) +
                            Dot(axis_rate, displacement);
        safe_s =
            std::min(safe_s, SafeStep(rate, bend, Dot(axis, displacement) - radii_m - floor_m));
      }
    }
    return safe_s;
  }

  double Bend(double turn_rad_s) const {
    const double speed = of_a_.speed_m_s + of_b_.speed_m_s;
    const double turn = std::abs(turn_rad_s);
    if (turn == 0) return of_a_.bend_m_s2 + of_b_.bend_m_s2;
    double squared = 0;
    for (std::size_t i = 0; i < at_a_.count; ++i) {
      for (std::size_t j = 0; j < at_b_.count; ++j) {
        squared = std::max(squared, SquaredNorm(at_b_.corner_world[j] - at_a_.corner_world[i]));
      }
    }
    const double farthest_m = Sqrt(squared) + speed * (to_s_ - t_s_);
    return of_a_.bend_m_s2 + of_b_.bend_m_s2 + 2 * turn * speed + turn * turn * farthest_m;
  }

  const A& a_;
  const B& b_;
  Bounds of_a_;
  Bounds of_b_;
  double to_s_;
  bool a_stands_;
  bool b_stands_;
  double t_s_ = 0;
  Outline at_a_;
  Outline at_b_;
  Nearest nearest_;
};

template <typename A, typename B>
std::optional<double> AdvanceToContact(const A& a, const B& b, double from_s, double to_s) {
  Stretch<A, B> stretch(a, b, from_s, to_s);
  double t_s = from_s;
  while (t_s <= to_s) {
    stretch.EvaluateAt(t_s);
    const double gap_m = stretch.Gap();
    if (gap_m > kTouch_m) {
      t_s += stretch.SafeUntil(kTouch_m / 2);
      continue;
    }
    if (stretch.Rate() < -kSliding_m_s) return t_s;
    t_s += std::max(kShortestStep_s, stretch.SafeUntil(gap_m - kSink_m));
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> FirstOutlineContact(const Motion& a, const Motion& b, double from_s,
                                          double to_s) {
  return AdvanceToContact(a, b, from_s, to_s);
}

std::optional<double> FirstOutlineContact(const Motion& a, const Leaf& leaf, double from_s,
                                          double to_s) {
  return AdvanceToContact(a, leaf, from_s, to_s);
}

// Walks through the stretch in steps in which the gap cannot get below what was already seen. A
// gap that closes is followed down to where it opens again first, so that the walk needs few steps.
ClosestMoment SmallerGap(const Motion& a, const Motion& b, double from_s, double to_s,
                         const ClosestMoment& smallest) {
  Stretch<Motion, Motion> stretch(a, b, from_s, to_s);
  ClosestMoment best = smallest;
  const auto evaluate_at = [&](double t_s) {
    stretch.EvaluateAt(t_s);
    if (stretch.Gap() < best.gap_m) best = {stretch.Gap(), t_s};
  };
  evaluate_at(to_s);
  double t_s = from_s;
  while (t_s < to_s) {
    evaluate_at(t_s);
    if (best.t_s == t_s && stretch.Rate() < 0) {
      double closing_s = t_s;
      double opening_s = to_s;
      while (opening_s - closing_s > 1e-9) {
        const double middle_s = (closing_s + opening_s) / 2;
        evaluate_at(middle_s);
        (stretch.Rate() < 0 ? closing_s : opening_s) = middle_s;
      }
      stretch.EvaluateAt(t_s);
    }
    t_s += std::max(kShortestStep_s, stretch.SafeUntil(best.gap_m - kTouch_m));
  }
  return best;
}

}  // namespace giveway::sim
