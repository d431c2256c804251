// The kernel in every vector width against the reference formulas: to the bit.
#include "sim_world/sensors/sonar_kernel.h"

#include <gtest/gtest.h>

#include <string>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/sensors/sonar_ring.h"

namespace giveway::sim {
namespace {

constexpr int kRounds = 3000;

struct Ring {
  std::array<Cone, kSensorCount> cones;
  ConeRing lanes;
};

Ring RandomRing(Random* random) {
  Ring ring;
  const double half = random->Uniform(0.05, 1.5);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const double bearing = random->Uniform(-kPi, kPi);
    ring.cones[i] = {.apex = {random->Uniform(-0.3, 0.3), random->Uniform(-0.3, 0.3)},
                     .axis = {Cos(bearing), Sin(bearing)},
                     .cos_half = Cos(half),
                     .sin_half = Sin(half),
                     .max_range_m = kSilence_m};
  }
  ring.lanes = RingOf(ring.cones);
  return ring;
}

Incidence RandomIncidence(Random* random) {
  return random->Next() % 2 == 0 ? Incidence{} : IncidenceUpTo(random->Uniform(0.1, 1.5));
}

class SonarKernelOf : public testing::TestWithParam<SimdWidth> {
 protected:
  void SetUp() override {
    if (!HasSimd(GetParam())) GTEST_SKIP() << "not on this CPU";
  }
};

TEST_P(SonarKernelOf, HearsDiscsAsTheReferenceToTheBit) {
  Random random(41);
  int heard = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Ring ring = RandomRing(&random);
    const Incidence incidence = RandomIncidence(&random);
    NearDiscs discs;
    const std::uint64_t count = 1 + random.Next() % 3;
    Lanes range_m;
    range_m.of.fill(kSilence_m);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 centre = {random.Uniform(-6, 6), random.Uniform(-6, 6)};
      discs.Add(centre, random.Uniform(0.01, 1));
    }
    KernelOf(GetParam()).hear_discs(ring.lanes, {.incidence = incidence}, discs, &range_m);
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      double expected_m = kSilence_m;
      for (std::size_t d = 0; d < count; ++d) {
        const auto one =
            RangeToDisc(ring.cones[i], {discs.x[d], discs.y[d]}, discs.radius_m[d], incidence);
        expected_m = std::min(expected_m, one.value_or(kSilence_m));
      }
      ASSERT_EQ(range_m.of[i], expected_m);
      heard += expected_m < kSilence_m;
    }
  }
  EXPECT_GT(heard, kRounds);
  EXPECT_LT(heard, kRounds * 15);
}

TEST_P(SonarKernelOf, HearsSegmentsAsTheReferenceToTheBit) {
  Random random(42);
  int heard = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Ring ring = RandomRing(&random);
    const Incidence incidence = RandomIncidence(&random);
    NearSegments segments;
    const std::uint64_t count = 1 + random.Next() % 3;
    Lanes range_m;
    range_m.of.fill(kSilence_m);
    std::vector<SceneSegment> all(count);
    for (SceneSegment& one : all) {
      one.from_world = {random.Uniform(-6, 6), random.Uniform(-6, 6)};
      one.to_world = {random.Uniform(-6, 6), random.Uniform(-6, 6)};
      const std::uint64_t kind = random.Next() % 8;
      if (kind == 0) one.to_world = one.from_world;                         // a point
      if (kind == 1) one.from_world = ring.cones[random.Next() % 16].apex;  // on a transducer
      if (kind == 2) one.to_world.x = one.from_world.x;
      segments.Add(one.from_world, one.to_world);
    }
    KernelOf(GetParam()).hear_segments(ring.lanes, {.incidence = incidence}, segments, &range_m);
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      double expected_m = kSilence_m;
      for (const SceneSegment& segment : all) {
        const auto one =
            RangeToSegment(ring.cones[i], segment.from_world, segment.to_world, incidence);
        expected_m = std::min(expected_m, one.value_or(kSilence_m));
      }
      ASSERT_EQ(range_m.of[i], expected_m);
      heard += expected_m < kSilence_m;
    }
  }
  EXPECT_GT(heard, kRounds);
  EXPECT_LT(heard, kRounds * 15);
}

std::string NameOf(const testing::TestParamInfo<SimdWidth>& info) {
  if (info.param == SimdWidth::kPlain) return "Plain";
  return info.param == SimdWidth::kAvx2 ? "Avx2" : "Avx512";
}

INSTANTIATE_TEST_SUITE_P(Widths, SonarKernelOf,
                         testing::Values(SimdWidth::kPlain, SimdWidth::kAvx2, SimdWidth::kAvx512),
                         NameOf);

TEST(SonarKernel, TheFastestWidthIsOneThisCpuHas) {
  EXPECT_TRUE(HasSimd(SimdWidth::kPlain));
  EXPECT_TRUE(HasSimd(FastestSimd()));
}

// Ten times more objects than a list holds, in a scene: nothing is lost between lists or in a grid.
TEST_P(SonarKernelOf, ACrowdedSceneIsHeardAsOneByOne) {
  Random random(43);
  RobotModel profile = PioneerP3dx();
  for (SensorMount& mount : profile.sonar) mount.enabled = true;
  const SonarRing ring(profile, GetParam());
  for (int round = 0; round < 20; ++round) {
    std::vector<Wall> walls(round % 2 == 0 ? 700 : 5);
    for (Wall& wall : walls) {
      wall.from_world = {random.Uniform(-6, 6), random.Uniform(-6, 6)};
      wall.to_world = wall.from_world + Vec2{random.Uniform(-1, 1), random.Uniform(-1, 1)};
    }
    Scene scene(walls);
    std::vector<Disc> discs(round % 3 == 0 ? 1500 : 10);
    for (Owner i = 0; i < discs.size(); ++i) {
      discs[i] = {{random.Uniform(-6, 6), random.Uniform(-6, 6)}, random.Uniform(0.01, 0.2)};
      scene.AddDisc(discs[i].centre_world, discs[i].radius_m, i);
    }
    scene.Index();
    const Pose pose = {{random.Uniform(-1, 1), random.Uniform(-1, 1)}, random.Uniform(-3, 3)};
    const Readings one_by_one = ring.Sense(pose, Tick{1}, discs, 3, walls);
    const Lanes heard = ring.Hear(scene, pose, 3);
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      ASSERT_EQ(one_by_one[i].kind == Echo::kEcho, heard.of[i] != kSilence_m);
      if (one_by_one[i].kind == Echo::kEcho) {
        ASSERT_EQ(one_by_one[i].range_m, heard.of[i]);
      }
    }
  }
}

TEST(SonarRing, EqualProfilesShareOneRing) {
  SonarRings rings;
  RobotModel other = PioneerP3dx();
  other.sonar[3].bearing_rad += 0.01;
  const SonarRing& first = rings.Of(PioneerP3dx());
  EXPECT_NE(&rings.Of(other), &first);
  EXPECT_EQ(&rings.Of(PioneerP3dx()), &first);
}

TEST(SonarRing, InABoxTheRangeIsZeroUnlessItIsTheOwn) {
  Scene scene({});
  scene.AddBox({{10, 10}, 0.4}, {0.25, 0.2}, 5);
  scene.Index();
  const SonarRing ring(PioneerP3dx());
  const Pose pose = {{10, 10}, 0.4};
  EXPECT_EQ(ring.Hear(scene, pose, 4).of[3], 0);
  EXPECT_EQ(ring.Hear(scene, pose, 5).of[3], kSilence_m);
}

}  // namespace
}  // namespace giveway::sim
