// Radar, lidar and camera against references that do not use their closed forms: the ultrasonics'
// own cone, and outlines sampled point by point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/sensors/sensor.h"
#include "sim_world/sensors/sonar_cone.h"

namespace giveway::sim {
namespace {

constexpr int kPlaces = 400;

struct Box {
  Pose pose;
  Vec2 half_m;
};

// Shapes round a sensor, kept apart from the scene so that a reference can go through them one by
// one.
struct Place {
  std::vector<Wall> walls;
  std::vector<std::pair<Vec2, double>> discs;
  std::vector<Box> boxes;
  Pose sensor;
};

Vec2 PointWithin(Random* random, double reach_m) {
  const double x = random->Uniform(-reach_m, reach_m);
  return {x, random->Uniform(-reach_m, reach_m)};
}

Place AnyPlace(std::uint64_t seed) {
  Random random(seed);
  Place place;
  const auto far = [&] {
    Vec2 point = PointWithin(&random, 12);
    while (Norm(point) < 1.5) point = PointWithin(&random, 12);
    return point;
  };
  for (int i = 0; i < 3; ++i) place.walls.push_back({far(), far()});
  for (int i = 0; i < 5; ++i) place.discs.emplace_back(far(), random.Uniform(0.05, 0.8));
  for (int i = 0; i < 3; ++i) {
    place.boxes.push_back({{far(), random.Uniform(-kPi, kPi)},
                           {random.Uniform(0.05, 0.8), random.Uniform(0.05, 0.5)}});
  }
  place.sensor = {{}, random.Uniform(-kPi, kPi)};
  return place;
}

Scene SceneOf(const Place& place) {
  Scene scene(place.walls);
  Owner owner = 1;
  scene.AddDisc(place.sensor.position_world, 0.25, 0);  // the own body
  for (const auto& [centre, radius_m] : place.discs) scene.AddDisc(centre, radius_m, owner++);
  for (const Box& box : place.boxes) scene.AddBox(box.pose, box.half_m, owner++);
  scene.Index();
  return scene;
}

SensorView ViewOf(const Scene& scene, const Place& place, std::span<const OwnerFacts> facts = {}) {
  return {.scene = scene, .facts = facts, .self = 0, .world_from_body = place.sensor};
}

std::array<Vec2, 4> CornersOf(const Box& box) {
  std::array<Vec2, 4> corners;
  const std::array<Vec2, 4> signs = {{{1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = ToWorld(box.pose, {signs[i].x * box.half_m.x, signs[i].y * box.half_m.y});
  }
  return corners;
}

// ---- lidar

// A point moved along the ray until it nearly touches some shape, by the distance to the nearest
// one: needs only the distance of a point from a shape.
double DistanceToNearest(const Place& place, Vec2 point) {
  double nearest = 1e9;
  const auto segment = [&](Vec2 from, Vec2 to) {
    const Vec2 side = to - from;
    const double u = std::clamp(Dot(point - from, side) / SquaredNorm(side), 0.0, 1.0);
    nearest = std::min(nearest, Norm(point - (from + u * side)));
  };
  for (const Wall& wall : place.walls) segment(wall.from_world, wall.to_world);
  for (const auto& [centre, radius_m] : place.discs) {
    nearest = std::min(nearest, Norm(point - centre) - radius_m);
  }
  for (const Box& box : place.boxes) {
    const std::array<Vec2, 4> corners = CornersOf(box);
    for (std::size_t i = 0; i < 4; ++i) segment(corners[i], corners[(i + 1) % 4]);
  }
  return nearest;
}

double March(const Place& place, Vec2 direction) {
  double along = 0;
  for (int i = 0; i < 20'000 && along <= kLidarRange_m; ++i) {
    const double free_m = DistanceToNearest(place, place.sensor.position_world + along * direction);
    if (free_m < 1e-7) return along;
    along += free_m;
  }
  return 2 * kLidarRange_m;
}

TEST(Lidar, MeetsWhatMarchingAlongTheBeamMeets) {
  for (int seed = 0; seed < kPlaces / 10; ++seed) {
    const Place place = AnyPlace(static_cast<std::uint64_t>(seed));
    const Scene scene = SceneOf(place);
    const LidarScan scan = SenseLidar(ViewOf(scene, place));
    for (std::size_t i = 0; i < kLidarBeams; ++i) {
      const double bearing = place.sensor.heading_rad + Radians(static_cast<double>(i) - 90.0);
      const double expected = March(place, {Cos(bearing), Sin(bearing)});
      if (std::abs(expected - kLidarRange_m) < 1e-3) continue;
      if (expected > kLidarRange_m) {
        EXPECT_EQ(scan.echo[i], Echo::kClear) << seed << " beam " << i;
      } else {
        ASSERT_EQ(scan.echo[i], Echo::kEcho) << seed << " beam " << i;
        // A grazing ray comes within a hair of the surface before it meets it.
        EXPECT_NEAR(scan.range_m[i], expected, 2e-3) << seed << " beam " << i;
        EXPECT_GE(scan.range_m[i], expected - 1e-6) << seed << " beam " << i;
      }
    }
  }
}

TEST(Lidar, SeesAheadAndNotBehindAndNotItself) {
  Scene scene({});
  scene.AddDisc({0, 0}, 0.25, 0);
  scene.AddDisc({3, 0}, 0.5, 1);
  scene.AddDisc({-2, 0}, 0.5, 2);
  scene.Index();
  const LidarScan scan = SenseLidar({.scene = scene, .self = 0});
  EXPECT_DOUBLE_EQ(scan.range_m[90], 2.5);
  EXPECT_EQ(std::ranges::count(scan.echo, Echo::kEcho), 19);  // asin(0.5 / 3) is 9.6 degrees
}

TEST(Lidar, InAShapeEverythingIsAtNothing) {
  Scene scene({});
  scene.AddBox({{0.5, 0}, 0}, {1, 1}, 4);
  scene.Index();
  const LidarScan scan = SenseLidar({.scene = scene, .self = 0});
  EXPECT_EQ(std::ranges::count(scan.echo, Echo::kEcho), static_cast<int>(kLidarBeams));
  EXPECT_EQ(std::ranges::count(scan.range_m, 0.0), static_cast<int>(kLidarBeams));
}

// ---- radar

// The ultrasonics' closed form with the radar's cones: range of each shape by itself.
std::vector<double> RangesByCone(const Place& place, double half_angle_rad, double range_m) {
  const Cone cone{.apex = place.sensor.position_world,
                  .axis = Forward(place.sensor),
                  .cos_half = Cos(half_angle_rad),
                  .sin_half = Sin(half_angle_rad),
                  .max_range_m = range_m};
  std::vector<double> ranges;
  for (const Wall& wall : place.walls) {
    if (auto range = RangeToSegment(cone, wall.from_world, wall.to_world)) ranges.push_back(*range);
  }
  for (const auto& [centre, radius_m] : place.discs) {
    if (auto range = RangeToDisc(cone, centre, radius_m)) ranges.push_back(*range);
  }
  for (const Box& box : place.boxes) {
    const std::array<Vec2, 4> corners = CornersOf(box);
    for (std::size_t i = 0; i < 4; ++i) {
      if (auto range = RangeToSegment(cone, corners[i], corners[(i + 1) % 4])) {
        ranges.push_back(*range);
      }
    }
  }
  return ranges;
}

bool Contains(const std::vector<double>& ranges, double range_m) {
  return std::ranges::any_of(ranges,
                             [=](double known) { return std::abs(known - range_m) < 1e-9; });
}

TEST(Radar, EveryRangeIsTheConesAndTheNearestIsNeverMissed) {
  for (int seed = 0; seed < kPlaces; ++seed) {
    const Place place = AnyPlace(1000 + static_cast<std::uint64_t>(seed));
    const Scene scene = SceneOf(place);
    const RadarScan scan = SenseRadar(ViewOf(scene, place));
    const auto near = RangesByCone(place, kRadarShortHalfAngle_rad, kRadarShortRange_m);
    const auto far = RangesByCone(place, kRadarLongHalfAngle_rad, kRadarLongRange_m);
    for (std::uint32_t i = 0; i < scan.count; ++i) {
      const RadarDetection& seen = scan.detections[i];
      EXPECT_TRUE(Contains(near, seen.range_m) || Contains(far, seen.range_m)) << seed;
      const double half = seen.long_range ? kRadarLongHalfAngle_rad : kRadarShortHalfAngle_rad;
      EXPECT_LE(std::abs(seen.bearing_rad), half + 1e-9) << seed;
      if (i > 0) {
        EXPECT_LE(scan.detections[i - 1].range_m, seen.range_m);
      }
    }
    // Nothing can hide the nearest point of all.
    const auto nearest_of = [](const std::vector<double>& ranges) {
      return ranges.empty() ? 1e9 : *std::ranges::min_element(ranges);
    };
    const double nearest = std::min(nearest_of(near), nearest_of(far));
    if (nearest > 1e8) {
      EXPECT_EQ(scan.count, 0U) << seed;
    } else {
      ASSERT_GT(scan.count, 0U) << seed;
      EXPECT_NEAR(scan.detections[0].range_m, nearest, 1e-9) << seed;
    }
  }
}

// The range rate is the change of range: move everything on for an instant and measure again.
TEST(Radar, RangeRateIsHowTheRangeOfADiscChanges) {
  Random random(5);
  for (int i = 0; i < kPlaces; ++i) {
    const Vec2 centre = {random.Uniform(1, 5), random.Uniform(-0.5, 0.5)};
    const std::array<OwnerFacts, 2> facts = {
        OwnerFacts{}, OwnerFacts{.velocity_world = PointWithin(&random, 2), .turn_rad_s = 3}};
    const Vec2 own = PointWithin(&random, 2);
    const auto seen = [&](double at_s) {
      Scene scene({});
      scene.AddDisc(centre + at_s * facts[1].velocity_world, 0.3, 1);
      scene.Index();
      return SenseRadar({.scene = scene,
                         .facts = facts,
                         .self = 0,
                         .world_from_body = {.position_world = at_s * own},
                         .velocity_world = own});
    };
    constexpr double kInstant_s = 1e-6;
    const RadarScan now = seen(0);
    const RadarScan then = seen(kInstant_s);
    ASSERT_EQ(now.count, 1U);
    ASSERT_EQ(then.count, 1U);
    // Where the beam's edge cuts the disc, another point of it is nearest from instant to instant.
    if (std::abs(std::abs(now.detections[0].bearing_rad) - kRadarShortHalfAngle_rad) < 1e-6) {
      continue;
    }
    EXPECT_NEAR(now.detections[0].range_rate_m_s,
                (then.detections[0].range_m - now.detections[0].range_m) / kInstant_s, 1e-4);
  }
}

TEST(Radar, ATurningBoxComesNearerWithItsCorner) {
  Scene scene({});
  scene.AddBox({{3, 0.5}, Radians(45)}, {0.5, 0.5}, 1);
  scene.Index();
  const std::array<OwnerFacts, 2> facts = {OwnerFacts{}, OwnerFacts{.turn_rad_s = 1}};
  const RadarScan scan = SenseRadar({.scene = scene, .facts = facts, .self = 0});
  ASSERT_EQ(scan.count, 1U);
  // The corner at (3 - 0.707, 0.5) moves with turn x arm = (0, -0.707).
  const Vec2 corner = {3 - Sqrt(0.5), 0.5};
  EXPECT_NEAR(scan.detections[0].range_m, Norm(corner), 1e-12);
  EXPECT_NEAR(scan.detections[0].range_rate_m_s, Dot(corner, {0, -Sqrt(0.5)}) / Norm(corner),
              1e-12);
}

TEST(Radar, WhatStandsBehindSomethingIsUnseen) {
  Scene scene({});
  scene.AddDisc({2, 0}, 0.4, 1);
  scene.AddDisc({5, 0}, 0.3, 2);
  scene.Index();
  EXPECT_EQ(SenseRadar({.scene = scene, .self = 0}).count, 1U);
  EXPECT_EQ(SenseRadar({.scene = scene, .self = 1}).count, 1U);  // not hidden by its own body
  EXPECT_NEAR(SenseRadar({.scene = scene, .self = 1}).detections[0].range_m, 4.7, 1e-12);
}

TEST(Radar, OnlyTheLongBeamSeesFarAndOnlyTheShortOneSeesWide) {
  Scene scene({});
  scene.AddDisc({12, 0}, 0.4, 1);
  scene.AddDisc({3, 2}, 0.4, 2);
  scene.AddDisc({9, 6}, 0.4, 3);
  scene.AddDisc({21, 1}, 0.4, 4);
  scene.Index();
  const RadarScan scan = SenseRadar({.scene = scene, .self = 0});
  ASSERT_EQ(scan.count, 2U);
  EXPECT_FALSE(scan.detections[0].long_range);
  EXPECT_TRUE(scan.detections[1].long_range);
  EXPECT_NEAR(scan.detections[1].range_m, 11.6, 1e-12);
}

TEST(Radar, OfManyTheNearestWinAndTheOrderOfAddingDoesNotShow) {
  const auto sense = [](bool backwards) {
    Scene scene({});
    for (Owner i = 0; i < 60; ++i) {
      const Owner owner = backwards ? 59 - i : i;
      // A fan of posts, each further than its neighbour, none behind another.
      const double bearing = Radians(-38 + 1.25 * owner);
      const double range = 3 + 0.03 * owner;
      scene.AddDisc({range * Cos(bearing), range * Sin(bearing)}, 0.01, owner);
    }
    scene.Index();
    return SenseRadar({.scene = scene, .self = kNoOwner});
  };
  const RadarScan forwards = sense(false);
  const RadarScan backwards = sense(true);
  ASSERT_EQ(forwards.count, kMaxDetections);
  for (std::size_t i = 0; i < kMaxDetections; ++i) {
    EXPECT_NEAR(forwards.detections[i].range_m, 2.99 + 0.03 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(forwards.detections[i].range_m, backwards.detections[i].range_m);
    EXPECT_EQ(forwards.detections[i].bearing_rad, backwards.detections[i].bearing_rad);
  }
}

TEST(Radar, AWallMetTwiceIsOneDetection) {
  const std::vector<Wall> walls = {{{2, -30}, {2, 30}}};
  Scene scene(walls);
  scene.Index();
  const RadarScan scan = SenseRadar({.scene = scene, .self = 0});
  ASSERT_EQ(scan.count, 1U);
  EXPECT_NEAR(scan.detections[0].range_m, 2, 1e-12);
}

}  // namespace
}  // namespace giveway::sim
