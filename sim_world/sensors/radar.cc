// Radar: a long and a short beam, one detection per body and wall, at its nearest point in either
// beam. Simple on purpose: a body is seen or hidden as a whole, by whether the straight line to
// that one point is free; no other point of a hidden body is tried.
#include <algorithm>
#include <optional>
#include <tuple>

#include "services/types/math/math.h"
#include "sim_world/geometry/ray.h"
#include "sim_world/sensors/beam.h"
#include "sim_world/sensors/sensor.h"

namespace giveway::sim {
namespace {

// What is nearer than the point itself by less than this is the point itself.
constexpr double kSameSurface_m = 1e-6;

bool IsNearer(const RadarDetection& a, const RadarDetection& b) {
  return std::tie(a.range_m, a.bearing_rad, a.range_rate_m_s) <
         std::tie(b.range_m, b.bearing_rad, b.range_rate_m_s);
}

class Radar {
 public:
  explicit Radar(const SensorView& view)
      : view_(view),
        body_(view.world_from_body),
        long_(BeamOf(kRadarLongHalfAngle_rad, kRadarLongRange_m)),
        short_(BeamOf(kRadarShortHalfAngle_rad, kRadarShortRange_m)) {
    scan_.vehicle = view.vehicle;
    scan_.epoch = view.epoch;
    scan_.tick = view.tick;
  }

  RadarScan Sense() {
    const Vec2 at_world = view_.world_from_body.position_world;
    const SceneDiscs discs = view_.scene.Discs();
    view_.scene.DiscsNear(at_world, kRadarLongRange_m, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i != end; ++i) {
        SeeDisc({discs.x_world[i], discs.y_world[i]}, discs.radius_m[i], discs.owner[i]);
      }
    });
    view_.scene.BoxesNear(at_world, kRadarLongRange_m,
                          [this](const SceneBox& box) { SeeBox(box); });
    view_.scene.WallsNear(at_world, kRadarLongRange_m,
                          [this](std::uint32_t wall) { SeeSegment(view_.scene.Walls()[wall]); });
    view_.scene.LeavesNear(at_world, kRadarLongRange_m,
                           [this](const SceneSegment& leaf) { SeeSegment(leaf); });
    return scan_;
  }

 private:
  // The nearest point in either beam, by a function from a beam to the nearest point in it.
  template <typename NearestIn>
  std::optional<Vec2> InEither(NearestIn nearest_in) const {
    const std::optional<Vec2> near = nearest_in(short_);
    const std::optional<Vec2> far = nearest_in(long_);
    if (!near || !far) return near ? near : far;
    return SquaredNorm(*far) < SquaredNorm(*near) ? far : near;
  }

  void SeeDisc(Vec2 centre_world, double radius_m, Owner owner) {
    if (owner == view_.self) return;
    const Vec2 centre = body_.Point(centre_world);
    const auto nearest =
        InEither([&](const Beam& beam) { return NearestOfDisc(beam, centre, radius_m); });
    if (nearest) Detect(*nearest, owner, centre);
  }

  void SeeBox(const SceneBox& box) {
    if (box.owner == view_.self) return;
    const auto nearest = InEither([&](const Beam& beam) { return NearestOfBox(beam, box); });
    if (nearest) Detect(*nearest, box.owner, body_.Point(box.centre_world));
  }

  std::optional<Vec2> NearestOfBox(const Beam& beam, const SceneBox& box) const {
    if (box.Holds(view_.world_from_body.position_world)) return Vec2{};
    std::optional<Vec2> nearest;
    for (std::size_t i = 0; i < box.corners_world.size(); ++i) {
      const SceneSegment side = box.Side(i);
      const auto point =
          NearestOfSegment(beam, body_.Point(side.from_world), body_.Point(side.to_world));
      if (point && (!nearest || SquaredNorm(*point) < SquaredNorm(*nearest))) nearest = point;
    }
    return nearest;
  }

  void SeeSegment(const SceneSegment& segment) {
    if (segment.owner == view_.self && segment.owner != kNoOwner) return;
    const Vec2 from = body_.Point(segment.from_world);
    const Vec2 to = body_.Point(segment.to_world);
    const auto nearest =
        InEither([&](const Beam& beam) { return NearestOfSegment(beam, from, to); });
    if (nearest) Detect(*nearest, segment.owner, *nearest);
  }

  // `pivot` is what the owner turns about.
  void Detect(Vec2 point, Owner owner, Vec2 pivot) {
    const double range = Norm(point);
    const OwnerFacts facts = view_.FactsOf(owner);
    const Vec2 passing = body_.Direction(facts.velocity_world - view_.velocity_world) +
                         facts.turn_rad_s * Left(point - pivot);
    const RadarDetection detection{.range_m = range,
                                   .bearing_rad = Atan2(point.y, point.x),
                                   .range_rate_m_s = range > 0 ? Dot(point, passing) / range : 0,
                                   .long_range = Holds(long_, point)};
    const auto end = scan_.detections.begin() + scan_.count;
    const auto at = std::lower_bound(scan_.detections.begin(), end, detection, IsNearer);
    if (at == scan_.detections.end()) return;
    // A wall may be met twice, and two walls may meet in one corner: one point, one detection.
    if (at != end && !IsNearer(detection, *at)) return;
    if (IsHidden(point, range)) return;
    std::move_backward(at, std::min(end, scan_.detections.end() - 1),
                       std::min(end + 1, scan_.detections.end()));
    *at = detection;
    scan_.count = std::min<std::uint32_t>(scan_.count + 1, kMaxDetections);
  }

  bool IsHidden(Vec2 point, double range_m) const {
    const double free_m = range_m - kSameSurface_m;
    if (free_m <= 0) return false;
    const Vec2 direction = (1 / range_m) * point;
    const auto in_the_way = [free_m](std::optional<double> at_m) { return at_m && *at_m < free_m; };
    const Vec2 at_world = view_.world_from_body.position_world;
    bool hidden = view_.scene.BoxAround(at_world, view_.self) != kNoOwner;
    const SceneDiscs discs = view_.scene.Discs();
    view_.scene.DiscsNear(at_world, range_m, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i != end && !hidden; ++i) {
        if (discs.owner[i] == view_.self) continue;
        const Vec2 centre = body_.Point({discs.x_world[i], discs.y_world[i]});
        hidden = in_the_way(RayToDisc(direction, centre, discs.radius_m[i]));
      }
    });
    view_.scene.SegmentsNear(at_world, range_m, [&](const SceneSegment& segment) {
      if (hidden || (segment.owner == view_.self && segment.owner != kNoOwner)) return;
      hidden = in_the_way(
          RayToSegment(direction, body_.Point(segment.from_world), body_.Point(segment.to_world)));
    });
    return hidden;
  }

  const SensorView& view_;
  BodyFrame body_;
  Beam long_;
  Beam short_;
  RadarScan scan_;
};

}  // namespace

RadarScan SenseRadar(const SensorView& view) { return Radar(view).Sense(); }

}  // namespace giveway::sim
