// The typical tier against its own reference.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "services/types/math/math.h"
#include "sim_world/sensors/sonar_echo.h"
#include "tests/unit/sim_world/sonar_vehicle.h"

namespace giveway::sim {
namespace {

TEST(SonarTypical, NoiseIsAShareOfTheRangeWithoutBias) {
  SonarModel model = Faultless(SonarTier::kTypical);
  model.noise = 0.01;
  for (const double range_m : {0.5, 2.0, 4.0}) {
    OneVehicle vehicle(model);
    AddDiscAhead(&vehicle.scene, range_m);
    OneVehicle exact(Faultless(SonarTier::kIdeal));
    AddDiscAhead(&exact.scene, range_m);
    const double true_m = exact.Sense(1)[3].range_m;
    constexpr int kDraws = 20'000;
    double sum = 0;
    double sum_of_squares = 0;
    for (std::uint32_t tick = 1; tick <= kDraws; ++tick) {
      const double error = vehicle.Sense(tick)[3].range_m / true_m - 1;
      sum += error;
      sum_of_squares += error * error;
    }
    EXPECT_NEAR(sum / kDraws, 0, 4 * 0.01 / std::sqrt(kDraws)) << range_m;
    EXPECT_NEAR(std::sqrt(sum_of_squares / kDraws), 0.01, 0.01 * 4 / std::sqrt(2.0 * kDraws));
  }
}

TEST(SonarTypical, AShareOfFiringsHearsNothingWhichIsClearAndNotNoData) {
  SonarModel model = Faultless(SonarTier::kTypical);
  model.drop_out = 0.2;
  OneVehicle vehicle(model);
  AddDiscAhead(&vehicle.scene, 1);
  constexpr int kDraws = 20'000;
  int lost = 0;
  for (std::uint32_t tick = 1; tick <= kDraws; ++tick) {
    const RangeReading reading = vehicle.Sense(tick)[3];
    ASSERT_NE(reading.kind, Echo::kNoData);
    ASSERT_EQ(reading.tick, Tick{tick});
    lost += reading.kind == Echo::kClear;
  }
  EXPECT_NEAR(lost / static_cast<double>(kDraws), 0.2, 4 * std::sqrt(0.2 * 0.8 / kDraws));
}

TEST(SonarTypical, InTheBlindZoneEveryRangeReadsAsItsRim) {
  SonarModel model = Model(SonarTier::kTypical);
  model.drop_out = 0;
  for (const double range_m : {0.0, 0.05, 0.0999}) {
    OneVehicle vehicle(model);
    AddDiscAhead(&vehicle.scene, range_m);
    for (std::uint32_t tick = 1; tick < 50; ++tick) ASSERT_EQ(vehicle.Sense(tick)[3].range_m, 0.1);
  }
}

TEST(SonarTypical, NoiseNeverLeavesTheRangeOfTheSensor) {
  SonarModel model = Model(SonarTier::kTypical);
  model.noise = 2;
  for (const double range_m : {0.11, 1.0, 4.999}) {
    OneVehicle vehicle(model);
    AddDiscAhead(&vehicle.scene, range_m);
    for (std::uint32_t tick = 1; tick < 2000; ++tick) {
      for (const RangeReading& reading : vehicle.Sense(tick)) {
        if (reading.kind != Echo::kEcho) continue;
        ASSERT_GE(reading.range_m, 0.1);
        ASSERT_LE(reading.range_m, 5);
      }
    }
  }
}

// The reading of transducer 3 for a wall that leans away from the ray to its near end by this
// angle.
Echo HeardOfWallAt(double incidence_rad) {
  // Transducer 3 looks along 10 degrees; the ray along its left edge, 25 degrees, meets the wall's
  // near end and everything else of the wall lies outside the cone or further away.
  const Vec2 apex = {0.166, 0.027};
  const double edge = Radians(24.9);
  const Vec2 end = apex + 2.0 * Vec2{Cos(edge), Sin(edge)};
  const double along = edge + kPi / 2 - incidence_rad;
  const Wall wall = {end, end + 2.0 * Vec2{Cos(along), Sin(along)}};
  OneVehicle vehicle(Faultless(SonarTier::kTypical), {&wall, 1});
  return vehicle.Sense(1)[3].kind;
}

TEST(SonarTypical, AWallAnswersUpTo25DegreesOffItsNormal) {
  EXPECT_EQ(HeardOfWallAt(Radians(24.99)), Echo::kEcho);
  EXPECT_EQ(HeardOfWallAt(Radians(25.01)), Echo::kClear);
}

TEST(SonarTypical, ADiscAnswersUpTo25DegreesOffItsNormal) {
  const Cone cone = {.axis = {1, 0}, .cos_half = Cos(0.2), .sin_half = Sin(0.2), .max_range_m = 5};
  const Incidence incidence = IncidenceUpTo(Radians(25));
  // The cone's edge meets the rim where the normal is `off` degrees from it.
  const auto heard = [&](double off) {
    const double radius_m = 0.4;
    const double across = radius_m * Sin(Radians(off));
    const Vec2 edge = {Cos(0.2), Sin(0.2)};
    return RangeToDisc(cone, 2.0 * edge + across * Left(edge), radius_m, incidence).has_value();
  };
  EXPECT_TRUE(heard(24.99));
  EXPECT_FALSE(heard(25.01));
}

TEST(SonarTypical, WhatIsCutOffDoesNotHideWhatIsBehindIt) {
  // So slanted that it returns no echo, right through the cone; a disc behind it. Its ends, which
  // would return one as edges, lie outside.
  const Wall wall = {{0.7445, 0.716}, {2.291, -0.542}};
  OneVehicle vehicle(Faultless(SonarTier::kTypical), {&wall, 1});
  AddDiscAhead(&vehicle.scene, 3);
  EXPECT_NEAR(vehicle.Sense(1)[3].range_m, 3, 1e-9);
}

TEST(SonarTypical, NumbersHangOnVehicleTickAndTransducerOnly) {
  std::map<double, int> seen;
  for (const std::uint32_t id : {1U, 2U}) {
    for (const std::uint32_t seed : {1U, 2U}) {
      for (const std::uint64_t tick : {1U, 2U}) {
        for (const std::size_t transducer : {0U, 1U, 15U}) {
          const auto draw = [&] {
            return Measured(2, Model(SonarTier::kTypical), 5,
                            FiringRandom(seed, VehicleId{id}, tick, transducer));
          };
          ++seen[draw()];
          EXPECT_EQ(draw(), draw());
        }
      }
    }
  }
  EXPECT_EQ(seen.size(), 24U);
}

}  // namespace
}  // namespace giveway::sim
