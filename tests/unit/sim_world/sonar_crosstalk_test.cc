#include "sim_world/sensors/sonar_crosstalk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/sensors/line_of_sight.h"
#include "sim_world/sensors/sonar.h"

namespace giveway::sim {
namespace {

constexpr double kHalf = 15 * kPi / 180;

Pulse PulseAt(Vec2 apex, double bearing_rad, double max_range_m = 5) {
  return {.fired = true,
          .apex_world = apex,
          .axis_world = {Cos(bearing_rad), Sin(bearing_rad)},
          .cos_half = Cos(kHalf),
          .max_range_m = max_range_m};
}

TEST(Crosstalk, TwoThatFaceEachOtherReadHalfTheirDistance) {
  EXPECT_NEAR(CrosstalkRange(PulseAt({0, 0}, 0), PulseAt({3, 0}, kPi)), 1.5, 1e-12);
}

TEST(Crosstalk, EachMustLieInTheOthersCone) {
  const double edge = kHalf - 1e-6;
  const double beyond = kHalf + 1e-6;
  for (const double side : {-1.0, 1.0}) {
    EXPECT_LT(CrosstalkRange(PulseAt({0, 0}, side * edge), PulseAt({3, 0}, kPi)), 2);
    EXPECT_EQ(CrosstalkRange(PulseAt({0, 0}, side * beyond), PulseAt({3, 0}, kPi)), kSilence_m);
    EXPECT_LT(CrosstalkRange(PulseAt({0, 0}, 0), PulseAt({3, 0}, kPi + side * edge)), 2);
    EXPECT_EQ(CrosstalkRange(PulseAt({0, 0}, 0), PulseAt({3, 0}, kPi + side * beyond)), kSilence_m);
  }
  EXPECT_EQ(CrosstalkRange(PulseAt({0, 0}, 0), PulseAt({3, 0}, 0)), kSilence_m);
}

TEST(Crosstalk, WhatWouldReadBeyondTheRangeIsNotHeard) {
  EXPECT_NEAR(CrosstalkRange(PulseAt({0, 0}, 0), PulseAt({9.999, 0}, kPi)), 4.9995, 1e-12);
  EXPECT_EQ(CrosstalkRange(PulseAt({0, 0}, 0), PulseAt({10.001, 0}, kPi)), kSilence_m);
}

TEST(Crosstalk, WhoDoesNotFireNeitherHearsNorIsHeard) {
  EXPECT_EQ(CrosstalkRange(Pulse{}, PulseAt({3, 0}, kPi)), kSilence_m);
  Pulse off = PulseAt({3, 0}, kPi);
  off.fired = false;
  EXPECT_EQ(CrosstalkRange(PulseAt({0, 0}, 0), off), kSilence_m);
}

TEST(Crosstalk, AnythingInTheWayBlocksIt) {
  const auto blocked = [](const Scene& scene) { return IsBlocked(scene, {0, 0}, {4, 0}, 0, 1); };
  Scene scene({});
  scene.AddDisc({0, 0.1}, 0.25, 0);  // their own bodies do not stand between
  scene.AddBox({{4, 0}, 0.3}, {0.2, 0.2}, 1);
  scene.AddDisc({2, 0.3}, 0.29, 2);
  scene.AddDisc({4.5, 0}, 0.29, 2);  // behind, not between
  scene.AddSegment({2, 0.01}, {2, 1}, 3);
  scene.Index();
  EXPECT_FALSE(blocked(scene));
  Scene with_disc({});
  with_disc.AddDisc({2, 0.3}, 0.31, 2);
  with_disc.Index();
  EXPECT_TRUE(blocked(with_disc));
  Scene with_box({});
  with_box.AddBox({{2, 0.2}, 0}, {0.1, 0.21}, 2);
  with_box.Index();
  EXPECT_TRUE(blocked(with_box));
  const Wall across = {{2, -0.1}, {2, 1}};
  EXPECT_TRUE(blocked(Scene({&across, 1})));
  const Wall edge_on = {{1, 0}, {2, 0}};
  EXPECT_FALSE(blocked(Scene({&edge_on, 1})));
}

// Two vehicles face each other. Returns the front ranges the first reads at any time.
std::vector<double> RangesOfFirst(SonarTier tier, std::uint32_t other_id, double gap_m,
                                  std::span<const Wall> walls = {}) {
  SonarModel model{.tier = tier, .noise = 0, .drop_out = 0};
  RobotModel profile = PioneerP3dx();
  for (SensorMount& mount : profile.sonar) mount.bearing_rad = mount.position_body.x > 0 ? 0 : kPi;
  const SonarRing ring(profile);
  Scene scene(walls);
  const Pose poses[] = {{{0, 0}, 0}, {{gap_m, 0}, kPi}};
  for (Owner i = 0; i < 2; ++i) scene.AddDisc(poses[i].position_world, 0.25, i);
  scene.Index();
  SonarState states[2];
  const SonarSubject subjects[] = {{VehicleId{1}, 0, poses[0], &ring, &states[0]},
                                   {VehicleId{other_id}, 1, poses[1], &ring, &states[1]}};
  Sonar sonar(model, 3, Nanoseconds{40'000'000});
  std::vector<double> ranges_m;
  for (std::uint32_t tick = 1; tick <= 18; ++tick) {
    sonar.Sense(Tick{tick}, [&](double) { return SonarInstant{&scene, subjects}; });
  }
  for (const RangeReading& reading : states[0].readings) {
    if (reading.kind == Echo::kEcho) ranges_m.push_back(reading.range_m);
  }
  return ranges_m;
}

TEST(Crosstalk, AVehicleReadsTheOtherAtHalfItsDistance) {
  const std::vector<double> without = RangesOfFirst(SonarTier::kP3dx, 2, 4);
  const std::vector<double> with = RangesOfFirst(SonarTier::kCrosstalk, 2, 4);
  ASSERT_EQ(without.size(), 8U);
  ASSERT_EQ(with.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_GT(without[i], 3.5);  // 4 m less a radius and where the transducer sits
    EXPECT_NEAR(with[i], (4 - 0.069 - 0.166) / 2, 0.1) << i;
  }
}

TEST(Crosstalk, TheOwnEchoWinsWhereItIsNearer) {
  // The end of a wall next to the path, in the left transducers' cones only.
  const Wall beside = {{1, 0.2}, {1, 3}};
  const std::vector<double> without = RangesOfFirst(SonarTier::kP3dx, 2, 4, {&beside, 1});
  const std::vector<double> with = RangesOfFirst(SonarTier::kCrosstalk, 2, 4, {&beside, 1});
  ASSERT_EQ(without.size(), 8U);
  ASSERT_EQ(with.size(), 8U);
  EXPECT_EQ(with[0], without[0]);
  EXPECT_LT(with[0], 1);
  EXPECT_LT(with[7], without[7]);
}

TEST(Crosstalk, AWallBetweenKeepsItAway) {
  const Wall wall = {{2.5, -5}, {2.5, 5}};
  EXPECT_EQ(RangesOfFirst(SonarTier::kCrosstalk, 2, 4, {&wall, 1}),
            RangesOfFirst(SonarTier::kP3dx, 2, 4, {&wall, 1}));
}

TEST(Crosstalk, AmongManyTheGridFindsWhatASearchOverAllFinds) {
  Random random(61);
  const SonarRing ring(PioneerP3dx());
  const Scene scene({});
  int heard = 0;
  for (int round = 0; round < 20; ++round) {
    Crosstalk crosstalk;
    std::vector<Pulses> all;
    for (Owner i = 0; i < 200; ++i) {
      const Pose pose = {{random.Uniform(-15, 15), random.Uniform(-15, 15)},
                         random.Uniform(-kPi, kPi)};
      const std::size_t place = random.Next() % kArraySize;
      all.push_back(PulsesOf(ring, pose, {place, place + kArraySize}));
      crosstalk.Add(i, pose.position_world, all.back());
    }
    crosstalk.Index();
    for (std::size_t i = 0; i < all.size(); ++i) {
      double nearest_m = kSilence_m;
      for (std::size_t j = 0; j < all.size(); ++j) {
        if (j != i) nearest_m = std::min(nearest_m, CrosstalkRange(all[i][0], all[j][0]));
      }
      ASSERT_EQ(crosstalk.Nearest(scene, i, 0), nearest_m);
      ASSERT_EQ(crosstalk.Nearest(scene, i, 1), kSilence_m);  // the rear ring is switched off
      heard += nearest_m < kSilence_m;
    }
  }
  EXPECT_GT(heard, 100);
}

}  // namespace
}  // namespace giveway::sim
