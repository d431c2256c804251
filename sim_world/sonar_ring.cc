#include "sim_world/sonar_ring.h"

#include <algorithm>
#include <ranges>

#include "services/types/check.h"
#include "services/types/math.h"
#include "sim_world/geometry.h"

namespace giveway::sim {
namespace {

// What is gathered may lie this much farther away than it could be heard from, so that rounding
// loses nothing.
constexpr double kSlack_m = 1e-9;

// Tells walls named again from new ones, among the last few: hearing one twice costs time only.
class NewWalls {
 public:
  bool operator()(std::uint32_t wall) {
    const auto end = last_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, last_.size()));
    if (std::find(last_.begin(), end, wall) != end) return false;
    last_[count_++ % last_.size()] = wall;
    return true;
  }

 private:
  std::array<std::uint32_t, 32> last_;
  std::size_t count_ = 0;
};

void Keep(RangeReading* reading, std::optional<double> range_m) {
  if (!range_m || (reading->kind == Echo::kEcho && reading->range_m <= *range_m)) return;
  reading->kind = Echo::kEcho;
  reading->range_m = *range_m;
}

}  // namespace

SonarRing::SonarRing(const VehicleProfile& profile, SimdWidth width)
    : kernel_(&KernelOf(width)), max_range_m_(profile.sonar_max_range_m) {
  GIVEWAY_CHECK(profile.sonar_half_angle_rad > 0 && profile.sonar_half_angle_rad < kPi / 2,
                profile.sonar_half_angle_rad);
  cones_.cos_half = Cos(profile.sonar_half_angle_rad);
  cones_.sin_half = Sin(profile.sonar_half_angle_rad);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const SensorMount& mount = profile.sonar[i];
    const Cone cone = {.apex = mount.position_body,
                       .axis = {Cos(mount.bearing_rad), Sin(mount.bearing_rad)},
                       .cos_half = cones_.cos_half,
                       .sin_half = cones_.sin_half,
                       .max_range_m = max_range_m_};
    cones_body_[i] = cone;
    cones_.apex_x.of[i] = cone.apex.x;
    cones_.apex_y.of[i] = cone.apex.y;
    cones_.axis_x.of[i] = cone.axis.x;
    cones_.axis_y.of[i] = cone.axis.y;
    enabled_[i] = mount.enabled;
    if (mount.enabled) apex_reach_m_ = std::max(apex_reach_m_, Norm(cone.apex));
  }
}

bool operator==(const SonarRing& a, const SonarRing& b) {
  return a.kernel_ == b.kernel_ && a.cones_ == b.cones_ && a.enabled_ == b.enabled_ &&
         a.max_range_m_ == b.max_range_m_;
}

Vec2 SonarRing::Ear::ToBody(Vec2 point_world) const {
  const Vec2 offset_world = point_world - position_world;
  return {Dot(x_axis_world, offset_world), Cross(x_axis_world, offset_world)};
}

Vec2 SonarRing::Ear::ToWorld(Vec2 point_body) const {
  return position_world + point_body.x * x_axis_world + point_body.y * Left(x_axis_world);
}

double SonarRing::Reach() const { return apex_reach_m_ + max_range_m_ + kSlack_m; }

Lanes SonarRing::Hear(const Scene& scene, const Pose& world_from_body, Owner self,
                      Incidence incidence) const {
  const Ear ear = {.position_world = world_from_body.position_world,
                   .x_axis_world = Forward(world_from_body),
                   .self = self,
                   .incidence = incidence};
  Lanes range_m;
  range_m.of.fill(kSilence_m);
  HearDiscs(scene, ear, &range_m);
  HearSegments(scene, ear, &range_m);
  HearFromInBoxes(scene, ear, &range_m);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (!enabled_[i] || range_m.of[i] > max_range_m_) range_m.of[i] = kSilence_m;
  }
  return range_m;
}

void SonarRing::HearDiscs(const Scene& scene, Ear ear, Lanes* range_m) const {
  const SceneDiscs discs = scene.Discs();
  const double reach_m = Reach();
  NearDiscs near;
  const auto gather = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (near.count == kNearListSize) {
        kernel_->hear_discs(cones_, near, ear.incidence, range_m);
        near.count = 0;
      }
      // Written in any case and counted if wanted: half are, and a branch would guess badly.
      const Vec2 centre_body = ear.ToBody({discs.x_world[i], discs.y_world[i]});
      const double radius_m = discs.radius_m[i];
      const double limit_m = reach_m + radius_m;
      near.x[near.count] = centre_body.x;
      near.y[near.count] = centre_body.y;
      near.radius_m[near.count] = radius_m;
      const std::size_t foreign = discs.owner[i] != ear.self;
      const std::size_t in_reach = SquaredNorm(centre_body) <= limit_m * limit_m;
      near.count += foreign & in_reach;
    }
  };
  scene.DiscsNear(ear.position_world, reach_m, gather);
  kernel_->hear_discs(cones_, near, ear.incidence, range_m);
}

void SonarRing::HearSegments(const Scene& scene, Ear ear, Lanes* range_m) const {
  const double reach_m = Reach();
  NearSegments near;
  const auto take = [&](const SceneSegment& segment) {
    const Vec2 from = ear.ToBody(segment.from_world);
    const Vec2 to = ear.ToBody(segment.to_world);
    if (SquaredNorm(NearestOnSegment(from, to, {})) > reach_m * reach_m) return;
    if (near.count == kNearListSize) {
      kernel_->hear_segments(cones_, near, ear.incidence, range_m);
      near.count = 0;
    }
    near.from[near.count] = from;
    near.to[near.count] = to;
    ++near.count;
  };
  NewWalls is_new;
  scene.WallsNear(ear.position_world, reach_m, [&](std::uint32_t wall) {
    if (is_new(wall)) take(scene.Walls()[wall]);
  });
  scene.LooseSegmentsNear(ear.position_world, reach_m, [&](const SceneSegment& segment) {
    if (segment.owner != ear.self) take(segment);
  });
  if (near.count > 0) kernel_->hear_segments(cones_, near, ear.incidence, range_m);
}

void SonarRing::HearFromInBoxes(const Scene& scene, Ear ear, Lanes* range_m) const {
  scene.BoxesNear(ear.position_world, apex_reach_m_, [&](const SceneBox& box) {
    if (box.owner == ear.self) return;
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      if (box.Holds(ear.ToWorld(cones_body_[i].apex))) range_m->of[i] = 0;
    }
  });
}

Readings SonarRing::Sense(const Pose& world_from_body, Tick tick, std::span<const Disc> bodies,
                          std::size_t self, std::span<const Wall> walls) const {
  const Ear ear = {.position_world = world_from_body.position_world,
                   .x_axis_world = Forward(world_from_body)};
  Readings readings{};
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (!enabled_[i]) continue;
    readings[i] = {.kind = Echo::kClear, .tick = tick};
    const Cone& cone = cones_body_[i];
    for (std::size_t body = 0; body < bodies.size(); ++body) {
      if (body == self) continue;
      Keep(&readings[i],
           RangeToDisc(cone, ear.ToBody(bodies[body].centre_world), bodies[body].radius_m));
    }
    for (const Wall& wall : walls) {
      Keep(&readings[i],
           RangeToSegment(cone, ear.ToBody(wall.from_world), ear.ToBody(wall.to_world)));
    }
  }
  return readings;
}

const SonarRing& SonarRings::Of(const VehicleProfile& profile) {
  auto ring = std::make_unique<const SonarRing>(profile, width_);
  const auto same = std::ranges::find_if(rings_, [&](const auto& held) { return *held == *ring; });
  return same != rings_.end() ? **same : *rings_.emplace_back(std::move(ring));
}

}  // namespace giveway::sim
