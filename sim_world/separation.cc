#include "sim_world/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "sim_world/geometry/approach.h"

namespace giveway::sim {
namespace {

constexpr double kParted_m = 0.01;  // more than rounding and less than any manoeuvre

double GapNow(const Body& a, const Body& b) {
  return GapAt(StandingAt(a.profile, a.world_from_body), StandingAt(b.profile, b.world_from_body),
               0);
}

ClosestMoment ClosestOf(const Motion& a, const Motion& b, double dt_s) {
  ClosestMoment moment = ClosestWithin(a, b, dt_s);
  if (moment.gap_m <= kTouch_m) moment.gap_m = 0;
  return moment;
}

// Two discs that drive all of the tick come no nearer than this: their offset goes from the one at
// its start to the one at its end, except for the deviation of the arcs from their chords, |v w|
// dt^2 / 8. Below any gap if it is not that simple.
double LeastGap(const Motion& a, const Motion& b, Vec2 offset_at_end, double dt_s) {
  constexpr double kNobodyKnows_m = -1;
  constexpr double kRounding_m = 1e-9;
  const auto arc = [dt_s](const Motion& motion) {
    return !motion.IsBox() && motion.slide_world == Vec2{} && motion.stop_s >= dt_s;
  };
  if (!arc(a) || !arc(b)) return kNobodyKnows_m;
  const auto bend_m = [dt_s](const Twist& twist) {
    return std::abs(twist.forward_m_s * twist.turn_rad_s) * dt_s * dt_s / 8;
  };
  const Vec2 offset = b.start_world.position_world - a.start_world.position_world;
  const double distance_m = Norm(offset);
  if (distance_m <= 0) return kNobodyKnows_m;
  const double nearer_m = std::min(0.0, Dot(offset, offset_at_end - offset) / distance_m);
  return distance_m + nearer_m - a.radius_m - b.radius_m - bend_m(a.twist) - bend_m(b.twist) -
         kRounding_m;
}

}  // namespace

std::optional<double> Separation::Reach() const {
  if (!closest_) return std::nullopt;
  return closest_->gap_m;
}

void Separation::Observe(std::span<const Body> bodies, const Collidables& collidables,
                         std::span<const NearPair> pairs, double dt_s) {
  if (every_pair_) ObserveEveryPair(bodies, collidables, dt_s);
  if (closest_ && closest_->gap_m == 0) return;
  // Of equally near pairs the first in this order, independent of the search; an equal gap does not
  // replace a record from an earlier tick.
  using Rank = std::tuple<double, std::uint32_t, std::uint32_t>;
  Rank best = {closest_ ? closest_->gap_m : std::numeric_limits<double>::infinity(), 0, 0};
  for (const NearPair& pair : pairs) {
    if (!collidables.IsBody(pair.a) || pair.apart_m > std::get<double>(best)) continue;
    const Motion& of_a = collidables.motions[pair.b];
    const Motion& of_b = collidables.motions[pair.a];
    const Vec2 offset_at_end = bodies[pair.a].world_from_body.position_world -
                               bodies[pair.b].world_from_body.position_world;
    if (LeastGap(of_a, of_b, offset_at_end, dt_s) > std::get<double>(best)) continue;
    const ClosestMoment moment = ClosestOf(of_a, of_b, dt_s);
    const Rank rank = {moment.gap_m, pair.a, pair.b};
    if (!(rank < best)) continue;
    best = rank;
    closest_ = ClosestApproach{.vehicle = bodies[pair.b].vehicle,
                               .other = bodies[pair.a].vehicle,
                               .gap_m = moment.gap_m,
                               .position_world = PositionAt(of_a, moment.t_s),
                               .other_position_world = PositionAt(of_b, moment.t_s)};
  }
}

void Separation::ObserveEveryPair(std::span<const Body> bodies, const Collidables& collidables,
                                  double dt_s) {
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!bodies[a].present || !bodies[b].present) continue;
      const Motion& of_a = collidables.motions[a];
      const Motion& of_b = collidables.motions[b];
      double& pair_m = closest_of_pair_m_
                           .try_emplace({bodies[a].vehicle, bodies[b].vehicle},
                                        std::numeric_limits<double>::infinity())
                           .first->second;
      // Most pairs are far from their record: the travel of both in a tick rules it out.
      const double reach_m = pair_m + of_a.radius_m + of_b.radius_m + TravelBound(of_a, dt_s) +
                             TravelBound(of_b, dt_s);
      const Vec2 offset = of_b.start_world.position_world - of_a.start_world.position_world;
      if (SquaredNorm(offset) > reach_m * reach_m) continue;
      pair_m = std::min(pair_m, ClosestOf(of_a, of_b, dt_s).gap_m);
    }
  }
}

bool Separation::Parted(std::span<const Body> bodies) const {
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!bodies[a].present || !bodies[b].present) continue;
      const auto pair = closest_of_pair_m_.find({bodies[a].vehicle, bodies[b].vehicle});
      if (pair == closest_of_pair_m_.end()) continue;
      if (GapNow(bodies[a], bodies[b]) <= pair->second + kParted_m) return false;
    }
  }
  return true;
}

}  // namespace giveway::sim
