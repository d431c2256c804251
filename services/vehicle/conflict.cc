#include "services/vehicle/conflict.h"

#include <algorithm>
#include <limits>

#include "services/types/math.h"

namespace giveway {
namespace {

// Parallel paths run along each other for ever; this is far enough to stand for it.
constexpr double kFar_m = 1e6;

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
  return IsEmpty(both) ? kNowhere : both;
}

Stretch Hull(const Stretch& a, const Stretch& b) {
  return {std::min(a.begin_m, b.begin_m), std::max(a.end_m, b.end_m)};
}

// Where the line of `path` runs within `reach_m` of one point.
Stretch StretchNearPoint(const Path& path, Vec2 point_world, double reach_m) {
  const Vec2 to_point = point_world - path.from_world;
  const double along = Dot(to_point, path.direction_world);
  const double across = Cross(path.direction_world, to_point);
  const double half_squared = reach_m * reach_m - across * across;
  if (half_squared < 0) return kNowhere;
  const double half = Sqrt(half_squared);
  return {along - half, along + half};
}

}  // namespace

Stretch StretchNear(const Path& path, const Path& other, double reach_m) {
  const Vec2 offset = path.from_world - other.from_world;
  const Vec2& along = other.direction_world;
  // Beside the half-line: within reach across it and not before its start.
  const Stretch across =
      WhereBetween(Cross(along, offset), Cross(along, path.direction_world), -reach_m, reach_m);
  const Stretch ahead =
      WhereBetween(Dot(along, offset), Dot(along, path.direction_world), 0, 2 * kFar_m);
  // Round its start.
  const Stretch cap = StretchNearPoint(path, other.from_world, reach_m);
  return Hull(Intersection(across, ahead), cap);
}

std::optional<Conflict> FindConflict(const Path& own, const Path& peer, double reach_m) {
  const Stretch of_own = StretchNear(own, peer, reach_m);
  if (IsEmpty(of_own) || of_own.end_m <= 0) return std::nullopt;
  const Stretch of_peer = StretchNear(peer, own, reach_m);
  if (IsEmpty(of_peer) || of_peer.end_m <= 0) return std::nullopt;
  constexpr double kAcross = 0.5;  // the sine of 30 degrees
  const double sine = Cross(own.direction_world, peer.direction_world);
  return Conflict{of_own, of_peer, Magnitude(sine) > kAcross};
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
