#include "services/vehicle/estimation/conflict.h"

#include <algorithm>
#include <limits>

#include "services/types/math/math.h"

namespace giveway {
namespace {

// Empty, and so that the union with any other is the other.
constexpr Stretch kNowhere = {std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};

// {s : low <= offset + slope * s <= high}
Stretch WhereBetween(double offset, double slope, double low, double high) {
  if (slope < 1e-12 && slope > -1e-12) {
    return offset < low || offset > high ? kNowhere : Stretch{-kFar_m, kFar_m};
  }
  const double a = (low - offset) / slope;
  const double b = (high - offset) / slope;
  return {std::min(a, b), std::max(a, b)};
}

Stretch Intersection(const Stretch& a, const Stretch& b) {
  const Stretch both{std::max(a.begin_m, b.begin_m), std::min(a.end_m, b.end_m)};
  return both.begin_m > both.end_m ? kNowhere : both;
}

Stretch Hull(const Stretch& a, const Stretch& b) {
  return {std::min(a.begin_m, b.begin_m), std::max(a.end_m, b.end_m)};
}

// How two lines lie to each other, as both of their stretches ask it: where each starts by the
// other's axes (x along, y across), and the angle from the second to the first.
struct PairOfLines {
  Vec2 first_by_second;
  Vec2 second_by_first;
  double sine;
  double cosine;
};

PairOfLines PairOf(const Path& first, const Path& second) {
  const Vec2 offset = first.from_world - second.from_world;
  const Vec2& a = first.direction_world;
  const Vec2& b = second.direction_world;
  return {.first_by_second = {Dot(b, offset), Cross(b, offset)},
          .second_by_first = {-Dot(a, offset), -Cross(a, offset)},
          .sine = Cross(b, a),
          .cosine = Dot(b, a)};
}

PairOfLines Swapped(const PairOfLines& pair) {
  return {pair.second_by_first, pair.first_by_second, -pair.sine, pair.cosine};
}

// Where a line runs within `reach_m` of a point that lies there by its own axes.
Stretch StretchNearPoint(Vec2 point, double reach_m) {
  const double half_squared = reach_m * reach_m - point.y * point.y;
  if (half_squared < 0) return kNowhere;
  const double half = Sqrt(half_squared);
  return {point.x - half, point.x + half};
}

// The stretch of the first line near the half-line of the second. Inline: as a call of its own it
// takes a twentieth of a step with a hundred peers.
inline Stretch StretchNear(const PairOfLines& pair, double reach_m) {
  // Lateral to the half-line: within reach across it and not before its start.
  const Stretch across = WhereBetween(pair.first_by_second.y, pair.sine, -reach_m, reach_m);
  const Stretch ahead = WhereBetween(pair.first_by_second.x, pair.cosine, 0, 2 * kFar_m);
  // Round its start.
  const Stretch cap = StretchNearPoint(pair.second_by_first, reach_m);
  return Hull(Intersection(across, ahead), cap);
}

}  // namespace

Stretch StretchNear(const Path& path, const Path& other, double reach_m) {
  return StretchNear(PairOf(path, other), reach_m);
}

Stretch StretchNearSegment(const Path& path, const Path& other, double length_m, double reach_m) {
  const Path tail = {other.from_world + length_m * other.direction_world,
                     -1.0 * other.direction_world};
  // A segment is what two half-lines against each other share.
  return Intersection(StretchNear(path, other, reach_m), StretchNear(path, tail, reach_m));
}

std::optional<Conflict> FindConflict(const Path& own, const Path& peer, double reach_m) {
  const PairOfLines pair = PairOf(own, peer);
  const Stretch of_own = StretchNear(pair, reach_m);
  if (of_own.end_m <= 0) return std::nullopt;
  const Stretch of_peer = StretchNear(Swapped(pair), reach_m);
  if (of_peer.end_m <= 0) return std::nullopt;
  constexpr double kAcross = 0.5;  // the sine of 30 degrees
  return Conflict{of_own, of_peer, Magnitude(pair.sine) > kAcross};
}

double SpeedToStopWithin(double distance_m, double reaction_s, double deceleration_m_s2) {
  if (distance_m <= 0) return 0;
  // The positive root of v^2 / 2b + v * reaction - distance = 0.
  const double lost = deceleration_m_s2 * reaction_s;
  return Sqrt(lost * lost + 2 * deceleration_m_s2 * distance_m) - lost;
}

double TimeToCover(double distance_m, double speed_m_s, double cruise_m_s,
                   double acceleration_m_s2) {
  if (distance_m <= 0) return 0;
  if (speed_m_s >= cruise_m_s) return distance_m / cruise_m_s;
  const double rising_s = (cruise_m_s - speed_m_s) / acceleration_m_s2;
  const double rising_m = (cruise_m_s + speed_m_s) / 2 * rising_s;
  if (distance_m >= rising_m) return rising_s + (distance_m - rising_m) / cruise_m_s;
  const double final_speed = Sqrt(speed_m_s * speed_m_s + 2 * acceleration_m_s2 * distance_m);
  return (final_speed - speed_m_s) / acceleration_m_s2;
}

}  // namespace giveway
