#include "sim_world/separation.h"

#include <limits>
#include <tuple>

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

}  // namespace

std::optional<double> Separation::Reach() const {
  if (!closest_) return std::nullopt;
  return closest_->gap_m;
}

void Separation::Observe(std::span<const Body> bodies, const Things& things,
                         std::span<const NearPair> pairs, double dt_s) {
  if (every_pair_) ObserveEveryPair(bodies, things, dt_s);
  if (closest_ && closest_->gap_m == 0) return;
  // Of equally near pairs the first in this order, however they were found; none beats a record
  // from an earlier tick by being as near.
  using Rank = std::tuple<double, std::uint32_t, std::uint32_t>;
  Rank best = {closest_ ? closest_->gap_m : std::numeric_limits<double>::infinity(), 0, 0};
  for (const NearPair& pair : pairs) {
    if (!things.IsBody(pair.a) || pair.apart_m > std::get<double>(best)) continue;
    const Motion& of_a = things.motions[pair.b];
    const Motion& of_b = things.motions[pair.a];
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

void Separation::ObserveEveryPair(std::span<const Body> bodies, const Things& things, double dt_s) {
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!bodies[a].present || !bodies[b].present) continue;
      const Motion& of_a = things.motions[a];
      const Motion& of_b = things.motions[b];
      double& pair_m = closest_of_pair_m_
                           .try_emplace({bodies[a].vehicle, bodies[b].vehicle},
                                        std::numeric_limits<double>::infinity())
                           .first->second;
      // Most pairs are nowhere near their record: what both can drive in a tick rules it out.
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
