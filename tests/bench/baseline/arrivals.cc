#include "tests/bench/baseline/arrivals.h"

#include <algorithm>
#include <optional>

namespace giveway::bench {
namespace {

struct Line {
  Vec2 from;
  Vec2 along;  // to the other end
};

Line LineOf(const VehicleOptions& options) {
  const Vec2 from = options.start_world.position_world;
  return {from, options.goal.at_world - from};
}

double DistanceFrom(const Line& line, Vec2 point) {
  const double share =
      std::clamp(Dot(point - line.from, line.along) / SquaredNorm(line.along), 0.0, 1.0);
  return Norm(point - line.from - share * line.along);
}

bool Parallel(const Line& a, const Line& b) {
  constexpr double kLeast = 1e-6;
  const double turn = Cross(a.along, b.along);
  return turn * turn < kLeast * SquaredNorm(a.along) * SquaredNorm(b.along);
}

// How far along `own` the other crosses it.
std::optional<double> CrossingAt(const Line& own, const Line& other) {
  if (Parallel(own, other)) return std::nullopt;
  const double turn = Cross(own.along, other.along);
  const double own_share = Cross(other.from - own.from, other.along) / turn;
  const double other_share = Cross(other.from - own.from, own.along) / turn;
  const auto within = [](double share) { return share >= 0 && share <= 1; };
  if (!within(own_share) || !within(other_share)) return std::nullopt;
  return own_share * Norm(own.along);
}

}  // namespace

std::vector<Arrival> ArrivalsOf(const Scenario& scenario, double near_m) {
  std::vector<Arrival> arrivals;
  for (const VehicleOptions& options : scenario.vehicles) {
    const Line own = LineOf(options);
    Arrival& arrival = arrivals.emplace_back();
    arrival.comes_m = Norm(own.along);
    for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
      if (scenario.vehicles[i].id == options.id) continue;
      const Line other = LineOf(scenario.vehicles[i]);
      arrival.comes_m = std::min(arrival.comes_m, CrossingAt(own, other).value_or(arrival.comes_m));
      if (!Parallel(own, other)) continue;
      const bool stands_ahead = DistanceFrom(own, other.from) < near_m;
      const bool ends_farther = DistanceFrom(other, own.from + own.along) < near_m;
      if (stands_ahead || ends_farther) arrival.let_first.push_back(i);
    }
    arrival.comes_s = arrival.comes_m / options.cruise_m_s;
  }
  return arrivals;
}

}  // namespace giveway::bench
