#include "sim_world/sensors/sonar_ring.h"

#include <algorithm>
#include <ranges>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"

namespace giveway::sim {
namespace {

// Objects in the list may be this much beyond hearing range, so that rounding loses none.
constexpr double kRingSlack_m = 1e-9;

void Keep(RangeReading* reading, std::optional<double> range_m) {
  if (!range_m || (reading->kind == Echo::kEcho && reading->range_m <= *range_m)) return;
  reading->kind = Echo::kEcho;
  reading->range_m = *range_m;
}

}  // namespace

SonarRing::SonarRing(const RobotModel& profile, SimdWidth width)
    : kernel_(&KernelOf(width)), max_range_m_(profile.sonar_max_range_m) {
  GIVEWAY_CHECK(profile.sonar_half_angle_rad > 0 && profile.sonar_half_angle_rad < kPi / 2,
                profile.sonar_half_angle_rad);
  const double cos_half = Cos(profile.sonar_half_angle_rad);
  const double sin_half = Sin(profile.sonar_half_angle_rad);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const SensorMount& mount = profile.sonar[i];
    cones_body_[i] = {.apex = mount.position_body,
                      .axis = {Cos(mount.bearing_rad), Sin(mount.bearing_rad)},
                      .cos_half = cos_half,
                      .sin_half = sin_half,
                      .max_range_m = max_range_m_};
    enabled_[i] = mount.enabled;
    if (!mount.enabled) continue;
    enabled_bits_ |= 1U << i;
    sectors_ |= SectorOf(i);
    apex_reach_m_ = std::max(apex_reach_m_, Norm(mount.position_body));
  }
  cones_ = RingOf(cones_body_);
}

bool operator==(const SonarRing& a, const SonarRing& b) {
  return a.kernel_ == b.kernel_ && a.cones_ == b.cones_ && a.enabled_ == b.enabled_ &&
         a.max_range_m_ == b.max_range_m_;
}

Lanes SonarRing::Hear(const Scene& scene, const Pose& world_from_body, Owner self,
                      Incidence incidence, SectorSet sectors) const {
  const Receiver receiver = {.position_world = world_from_body.position_world,
                             .x_axis_world = Forward(world_from_body),
                             .self = self,
                             .reach_m = apex_reach_m_ + max_range_m_ + kRingSlack_m,
                             .incidence = incidence,
                             .sectors = sectors & sectors_};
  Lanes range_m;
  range_m.of.fill(kSilence_m);
  HearDiscs(scene, receiver, &range_m);
  HearSegments(scene, receiver, &range_m);
  HearFromInBoxes(scene, receiver, &range_m);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (!enabled_[i] || range_m.of[i] > max_range_m_) range_m.of[i] = kSilence_m;
  }
  return range_m;
}

void SonarRing::HearDiscs(const Scene& scene, const Receiver& receiver, Lanes* range_m) const {
  const SceneDiscs discs = scene.Discs();
  NearDiscs near;
  scene.DiscsNear(receiver.position_world, receiver.reach_m,
                  [&](std::size_t begin, std::size_t end) {
                    while (begin < end) {
                      begin += kernel_->gather_discs(receiver, discs, begin, end, &near);
                      if (begin >= end) return;
                      kernel_->hear_discs(cones_, receiver, near, range_m);
                      near.Clear();
                    }
                  });
  kernel_->hear_discs(cones_, receiver, near, range_m);
}

void SonarRing::HearSegments(const Scene& scene, const Receiver& receiver, Lanes* range_m) const {
  NearSegments near;
  const auto hear = [&] {
    kernel_->hear_segments(cones_, receiver, near, range_m);
    near.Clear();
  };
  const auto take_walls = [&](std::span<const std::uint32_t> walls) {
    while (!walls.empty()) {
      walls = walls.subspan(kernel_->gather_walls(receiver, scene.Walls(), walls, &near));
      if (!walls.empty()) hear();
    }
  };
  if (receiver.reach_m <= Scene::kListedReach_m) {
    take_walls(scene.WallsListedAt(receiver.position_world));
  } else {
    // Long walls come more than once: that costs time only.
    scene.WallsNear(receiver.position_world, receiver.reach_m, [&](std::uint32_t wall) {
      take_walls({&wall, 1});
    });
  }
  scene.LooseSegmentsNear(
      receiver.position_world, receiver.reach_m, [&](const SceneSegment& segment) {
        if (segment.owner == receiver.self) return;
        const Vec2 from = receiver.ToBody(segment.from_world);
        const Vec2 to = receiver.ToBody(segment.to_world);
        if (SquaredNorm(NearestOnSegment(from, to, {})) > receiver.reach_m * receiver.reach_m)
          return;
        if (near.count == kNearListSize) hear();
        near.Add(from, to);
      });
  if (near.count > 0) hear();
}

void SonarRing::HearFromInBoxes(const Scene& scene, const Receiver& receiver,
                                Lanes* range_m) const {
  scene.BoxesNear(receiver.position_world, apex_reach_m_, [&](const SceneBox& box) {
    if (box.owner == receiver.self) return;
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      if (box.Holds(receiver.ToWorld(cones_body_[i].apex))) range_m->of[i] = 0;
    }
  });
}

Readings SonarRing::Sense(const Pose& world_from_body, Tick tick, std::span<const Disc> bodies,
                          std::size_t self, std::span<const Wall> walls) const {
  const Receiver receiver = {.position_world = world_from_body.position_world,
                             .x_axis_world = Forward(world_from_body)};
  Readings readings{};
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (!enabled_[i]) continue;
    readings[i] = {.kind = Echo::kClear, .tick = tick};
    const Cone& cone = cones_body_[i];
    for (std::size_t body = 0; body < bodies.size(); ++body) {
      if (body == self) continue;
      Keep(&readings[i],
           RangeToDisc(cone, receiver.ToBody(bodies[body].centre_world), bodies[body].radius_m));
    }
    for (const Wall& wall : walls) {
      Keep(&readings[i],
           RangeToSegment(cone, receiver.ToBody(wall.from_world), receiver.ToBody(wall.to_world)));
    }
  }
  return readings;
}

const SonarRing& SonarRings::Of(const RobotModel& profile) {
  auto ring = std::make_unique<const SonarRing>(profile, width_);
  const auto same = std::ranges::find_if(rings_, [&](const auto& held) { return *held == *ring; });
  return same != rings_.end() ? **same : *rings_.emplace_back(std::move(ring));
}

}  // namespace giveway::sim
