#include "services/vehicle/situation/objects_ahead.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/situation/echoes.h"

namespace giveway {
namespace {

// A rate the own motion leaves unexplained: accelerating within a tick, rounding.
constexpr double kStandsStill_m_s = 0.1;
constexpr double kCameraSlack_rad = 0.0175;  // a degree

template <typename Scan>
double AgeSeconds(const HeldScan<Scan>& held, const OwnView& s) {
  return Seconds(TicksBetween(held.scan.tick, s.tick) * s.options.tick_period);
}

template <typename Scan>
bool IsFresh(const HeldScan<Scan>& held, const OwnView& s) {
  const Nanoseconds limit = s.options.ranges_age_limit;
  return held.scan.tick != kNoTick && s.now - held.taken <= limit &&
         AgeSeconds(held, s) <= Seconds(limit);
}

Vec2 At(double range_m, double bearing_rad) {
  return range_m * Vec2{Cos(bearing_rad), Sin(bearing_rad)};
}

// The time until the vehicle would stand, if it saw the obstacle and braked now.
double SecondsToStand(const OwnView& s) {
  return s.reaction_s + std::max(0.0, s.speed_m_s) / s.options.profile.deceleration_m_s2;
}

// Whether a camera that sees now names what is at the point a vehicle.
bool LooksLikeVehicle(const HeldScan<CameraScan>& camera, Vec2 point_world, const OwnView& s) {
  if (!IsFresh(camera, s)) return false;
  const Vec2 point = ToBody(camera.world_from_body, point_world);
  const double bearing = Atan2(point.y, point.x);
  const auto objects = std::span(camera.scan.objects).first(camera.scan.count);
  return std::any_of(objects.begin(), objects.end(), [bearing](const CameraObject& object) {
    const double off = WrapAngle(bearing - object.bearing_rad);
    const double half = object.half_width_rad + kCameraSlack_rad;
    return object.seen_class == SeenClass::kVehicle && off <= half && off >= -half;
  });
}

// Whether the object at the point is the body of a peer whose fresh beacon is believed.
bool IsKnownPeer(const SeenObjects& seen, Vec2 point_world, const Situation& s) {
  const bool on_shell =
      std::any_of(s.near.peers.begin(), s.near.peers.end(), [&](const PeerView& view) {
        const double from_shell_m =
            Norm(point_world - view.position_world) - view.peer->beacon.body_radius_m;
        return view.believed && from_shell_m < kSameBody_m && from_shell_m > -kSameBody_m;
      });
  return on_shell && LooksLikeVehicle(seen.camera, point_world, s.own);
}

// Carries the object seen at `range_m` and `bearing_rad` on by `moved_m` towards where the sensor
// was, and keeps it if it is in the corridor then.
template <typename Scan>
void Consider(const SeenObjects& seen, const HeldScan<Scan>& held, double range_m,
              double bearing_rad, double moved_m, const Situation& s,
              std::optional<ObjectAhead>* nearest) {
  // It comes no nearer than to the shell.
  const double nearest_m = std::min(range_m, s.own.options.profile.body_radius_m);
  const Vec2 then_body = At(std::max(nearest_m, range_m - moved_m), bearing_rad);
  const Vec2 then = InBody(s.own, ToWorld(held.world_from_body, then_body));
  const auto free_m = FreeBeforePoint(then, s.own.options.profile.body_radius_m);
  if (!free_m || (*nearest && (*nearest)->free_m <= *free_m)) return;
  const Vec2 now_world = ToWorld(held.world_from_body, At(range_m, bearing_rad));
  if (!IsKnownPeer(seen, now_world, s)) *nearest = ObjectAhead{*free_m, held.scan.tick};
}

}  // namespace

std::optional<ObjectAhead> NearestObstacle(const SeenObjects& seen, const Situation& s) {
  std::optional<ObjectAhead> nearest;
  if (IsFresh(seen.radar, s.own)) {
    const double on_s = AgeSeconds(seen.radar, s.own) + SecondsToStand(s.own);
    for (std::uint32_t i = 0; i < seen.radar.scan.count; ++i) {
      const RadarDetection& object = seen.radar.scan.detections[i];
      const double by_driving = seen.radar.speed_m_s * Cos(object.bearing_rad);
      const double nearing_m_s = -(object.range_rate_m_s + by_driving);
      const double moved_m = nearing_m_s > kStandsStill_m_s ? nearing_m_s * on_s : 0;
      Consider(seen, seen.radar, object.range_m, object.bearing_rad, moved_m, s, &nearest);
    }
  }
  if (IsFresh(seen.lidar, s.own)) {
    for (std::size_t i = 0; i < kLidarBeams; ++i) {
      if (seen.lidar.scan.echo[i] != Echo::kEcho) continue;
      const double bearing_rad = Radians(static_cast<double>(i) - 90.0);
      Consider(seen, seen.lidar, seen.lidar.scan.range_m[i], bearing_rad, 0, s, &nearest);
    }
  }
  return nearest;
}

}  // namespace giveway
