#include "sim_world/separation.h"

#include <cmath>
#include <limits>

namespace giveway::sim {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kParted_m = 0.01;  // more than rounding and less than any manoeuvre

double GapNow(const Body& a, const Body& b) {
  const Vec2 offset = b.world_from_body.position_world - a.world_from_body.position_world;
  return Norm(offset) - a.profile.body_radius_m - b.profile.body_radius_m;
}

}  // namespace

Separation::Separation(std::size_t bodies) : closest_of_pair_m_(PairCount(bodies), kNever) {}

void Separation::Observe(std::span<const Body> bodies, std::span<const Motion> motions,
                         double dt_s) {
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    if (!bodies[b].present) continue;
    for (std::size_t a = 0; a < b; ++a) {
      if (bodies[a].present) ObservePair(bodies, motions, a, b, dt_s);
    }
  }
}

void Separation::ObservePair(std::span<const Body> bodies, std::span<const Motion> motions,
                             std::size_t a, std::size_t b, double dt_s) {
  const Motion& of_a = motions[a];
  const Motion& of_b = motions[b];
  double& pair_m = closest_of_pair_m_[PairIndex(a, b)];
  // Most pairs are nowhere near their record: what both can drive in a tick rules it out.
  const double travel_m =
      dt_s * (std::abs(of_a.twist.forward_m_s) + std::abs(of_b.twist.forward_m_s));
  const double floor_m = pair_m + of_a.radius_m + of_b.radius_m + travel_m;
  const Vec2 offset = of_b.start_world.position_world - of_a.start_world.position_world;
  if (SquaredNorm(offset) > floor_m * floor_m) return;

  const ClosestMoment moment = ClosestWithin(of_a, of_b, dt_s);
  const double gap_m = moment.gap_m <= kTouch_m ? 0 : moment.gap_m;
  if (gap_m < pair_m) pair_m = gap_m;
  if (closest_ && closest_->gap_m <= gap_m) return;
  closest_ = ClosestApproach{.vehicle = bodies[a].vehicle,
                             .other = bodies[b].vehicle,
                             .gap_m = gap_m,
                             .position_world = PositionAt(of_a, moment.t_s),
                             .other_position_world = PositionAt(of_b, moment.t_s)};
}

bool Separation::Parted(std::span<const Body> bodies) const {
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const double pair_m = closest_of_pair_m_[PairIndex(a, b)];
      if (!bodies[a].present || !bodies[b].present || pair_m == kNever) continue;
      if (GapNow(bodies[a], bodies[b]) <= pair_m + kParted_m) return false;
    }
  }
  return true;
}

}  // namespace giveway::sim
