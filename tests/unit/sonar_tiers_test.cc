// Tiers typical and p3dx, each against its own reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "services/types/math.h"
#include "sim_world/sonar.h"
#include "sim_world/sonar_echo.h"

namespace giveway::sim {
namespace {

constexpr Nanoseconds kTickPeriod{50'000'000};

VehicleProfile WithAllTransducers() {
  VehicleProfile profile = PioneerP3dx();
  for (SensorMount& mount : profile.sonar) mount.enabled = true;
  return profile;
}

SonarModel Model(SonarTier tier) {
  SonarModel model;
  model.tier = tier;
  return model;
}

SonarModel Faultless(SonarTier tier) {
  SonarModel model = Model(tier);
  model.noise = 0;
  model.drop_out = 0;
  return model;
}

// One vehicle at the origin, looking along x, and what stands round it.
class OneVehicle {
 public:
  explicit OneVehicle(const SonarModel& model, std::span<const Wall> walls = {},
                      std::uint32_t id = 1, Nanoseconds tick_period = kTickPeriod)
      : scene(walls), id_(id), sonar_(model, 9, tick_period) {}

  const Readings& Sense(std::uint32_t tick) {
    const SonarSubject subject = {VehicleId{id_}, 0, pose, &ring_, &state_};
    sonar_.Sense(Tick{tick}, [&](double before_s) {
      asked_s.push_back(before_s);
      return SonarInstant{&scene, {&subject, 1}};
    });
    return state_.readings;
  }

  Scene scene;
  Pose pose;
  std::vector<double> asked_s;

 private:
  std::uint32_t id_;
  SonarRing ring_{WithAllTransducers()};
  SonarState state_;
  Sonar sonar_;
};

void AddDiscAhead(Scene* scene, double range_m) {
  scene->AddDisc({0.166 + range_m + 0.25, 0.027}, 0.25, 1);  // straight before transducer 3's apex
  scene->Index();
}

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

// A wall before the transducer at `tilt_rad`, so far to the side that the cone's edge meets it.
Echo HeardOfWallAt(double incidence_rad) {
  // Transducer 3 looks along 10 degrees; the ray along its left edge, 25 degrees, meets the wall's
  // near end and everything else of the wall lies outside the cone or farther away.
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
  // Nearly edge on, right before the transducer; a disc behind it.
  const Wall wall = {{1.0, 0.0}, {2.0, 0.2}};
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

TEST(SonarP3dx, EachTransducerFiresEvery320MillisecondsAndItsAgeIsRight) {
  OneVehicle vehicle(Faultless(SonarTier::kP3dx));
  AddDiscAhead(&vehicle.scene, 1);
  std::array<std::vector<double>, kSensorCount> fired_s;
  for (std::uint32_t tick = 1; tick <= 200; ++tick) {
    const Readings& readings = vehicle.Sense(tick);
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      if (readings[i].kind == Echo::kNoData) continue;
      ASSERT_GE(readings[i].fired_before_s, 0);
      ASSERT_LT(readings[i].fired_before_s, 0.05);
      const double at_s = Number(readings[i].tick) * 0.05 - readings[i].fired_before_s;
      if (!fired_s[i].empty() && std::abs(at_s - fired_s[i].back()) < 1e-9) continue;
      // It comes at the first tick at or after the end of its slot, and not before.
      ASSERT_GE(tick * 0.05, at_s + 0.04 - 1e-9);
      ASSERT_LT((tick - 1) * 0.05, at_s + 0.04 - 1e-9);
      fired_s[i].push_back(at_s);
    }
  }
  for (const std::vector<double>& times_s : fired_s) {
    ASSERT_GE(times_s.size(), 30U);
    EXPECT_LE(times_s.front(), 0.32 + 1e-9);
    for (std::size_t i = 1; i < times_s.size(); ++i) {
      ASSERT_NEAR(times_s[i] - times_s[i - 1], 0.32, 1e-9);
    }
    for (const double at_s : times_s) {
      ASSERT_NEAR(std::remainder(at_s, 0.04), 0, 1e-9);
    }
  }
}

TEST(SonarP3dx, OneTransducerOfEachArrayFiresAtATime) {
  const FiringSchedule schedule(Nanoseconds{40'000'000}, kTickPeriod, 9);
  std::map<std::size_t, int> first_places;
  for (std::uint32_t id = 1; id <= 400; ++id) {
    ++first_places[schedule.Firing(VehicleId{id}, 0)[0]];
    for (std::uint64_t slot = 0; slot < 16; ++slot) {
      const auto now = schedule.Firing(VehicleId{id}, slot);
      const auto next = schedule.Firing(VehicleId{id}, slot + 1);
      ASSERT_LT(now[0], 8U);
      ASSERT_EQ(now[1], now[0] + 8);
      ASSERT_EQ(next[0], (now[0] + 1) % 8);
    }
  }
  EXPECT_EQ(first_places.size(), 8U);
  for (const auto& [place, vehicles] : first_places) EXPECT_GT(vehicles, 20) << place;
}

TEST(SonarP3dx, EverySlotIsSensedOnceAndAtItsStart) {
  for (const int tick_ms : {10, 40, 50, 130}) {
    OneVehicle vehicle(Faultless(SonarTier::kP3dx), {}, 1, Nanoseconds{tick_ms * 1'000'000});
    double expected_s = 0;
    for (std::uint32_t tick = 1; tick <= 40; ++tick) {
      vehicle.asked_s.clear();
      vehicle.Sense(tick);
      for (const double before_s : vehicle.asked_s) {
        expected_s += 0.04;
        ASSERT_NEAR(tick * tick_ms * 1e-3 - before_s, expected_s, 1e-9) << tick_ms;
      }
      ASSERT_GT(expected_s + 0.04, tick * tick_ms * 1e-3) << tick_ms;
    }
  }
}

TEST(SonarP3dx, BeforeItsFirstFiringATransducerHasNoDataAndThenKeepsItsReading) {
  OneVehicle vehicle(Faultless(SonarTier::kP3dx));
  AddDiscAhead(&vehicle.scene, 1);
  for (const RangeReading& reading : vehicle.Sense(1)) EXPECT_EQ(reading.kind, Echo::kNoData);
  Readings before = vehicle.Sense(2);
  const auto count = [](const Readings& readings) {
    return std::ranges::count_if(readings, [](auto& r) { return r.kind != Echo::kNoData; });
  };
  EXPECT_EQ(count(before), 2);
  for (std::uint32_t tick = 3; tick <= 60; ++tick) {
    const Readings readings = vehicle.Sense(tick);
    ASSERT_GE(count(readings), count(before));
    before = readings;
  }
  EXPECT_EQ(count(before), 16);
  EXPECT_EQ(before[3].kind, Echo::kEcho);
  EXPECT_EQ(before[12].kind, Echo::kClear);
}

TEST(SonarP3dx, TheReadingIsOfTheFiringsMomentAndNotOfTheTick) {
  OneVehicle vehicle(Faultless(SonarTier::kP3dx));
  AddDiscAhead(&vehicle.scene, 1);
  std::uint32_t tick = 1;
  Tick fired = kNoTick;
  for (; fired == kNoTick; ++tick) fired = vehicle.Sense(tick)[3].tick;
  // The disc is gone, but until the next firing's result the old reading stays.
  vehicle.scene.Clear();
  vehicle.scene.Index();
  int kept = 0;
  for (; vehicle.Sense(tick)[3].tick == fired; ++tick) ++kept;
  EXPECT_GE(kept, 5);
  EXPECT_LE(kept, 6);
  EXPECT_EQ(vehicle.Sense(tick)[3].kind, Echo::kClear);
}

TEST(SonarTiers, TransducersSwitchedOffHaveNoDataInEveryTier) {
  const SonarRing ring(PioneerP3dx());
  const Scene scene({});
  for (const SonarTier tier :
       {SonarTier::kIdeal, SonarTier::kTypical, SonarTier::kP3dx, SonarTier::kCrosstalk}) {
    Sonar sonar(Faultless(tier), 1, kTickPeriod);
    SonarState state;
    const SonarSubject subject = {VehicleId{1}, 0, {}, &ring, &state};
    for (std::uint32_t tick = 1; tick < 20; ++tick) {
      sonar.Sense(Tick{tick}, [&](double) { return SonarInstant{&scene, {&subject, 1}}; });
    }
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      EXPECT_EQ(state.readings[i].kind, i < 8 ? Echo::kClear : Echo::kNoData) << i;
    }
  }
}

}  // namespace
}  // namespace giveway::sim
