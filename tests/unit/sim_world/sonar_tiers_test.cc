// The firing schedule of tier p3dx, and what holds in every tier.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "services/types/math/math.h"
#include "tests/unit/sim_world/sonar_vehicle.h"

namespace giveway::sim {
namespace {

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
  for (const std::uint32_t tick_ms : {10U, 40U, 50U, 130U}) {
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

// A fleet in a tight place with all faults, sensed in the given order and pieces.
std::vector<Readings> FleetReadings(SonarTier tier, bool backwards, const ParallelFor& parallel,
                                    SimdWidth width = FastestSimd()) {
  constexpr std::uint32_t kFleet = 40;
  SonarRings rings(width);
  const SonarRing& ring = rings.Of(WithAllTransducers());
  Scene scene({});
  std::vector<SonarState> states(kFleet);
  std::vector<SonarSubject> subjects;
  for (std::uint32_t i = 0; i < kFleet; ++i) {
    const Pose pose = {{0.9 * (i % 7), 0.9 * (i / 7)}, WrapAngle(2.4 * i)};
    scene.AddDisc(pose.position_world, 0.25, i);
    subjects.push_back({VehicleId{i + 1}, i, pose, &ring, &states[i]});
  }
  scene.Index();
  if (backwards) std::ranges::reverse(subjects);
  Sonar sonar(Model(tier), 5, kTickPeriod);
  for (std::uint32_t tick = 1; tick <= 20; ++tick) {
    sonar.Sense(
        Tick{tick},
        [&](double) {
          return SonarInstant{&scene, subjects};
        },
        parallel);
  }
  std::vector<Readings> readings;
  for (const SonarState& state : states) readings.push_back(state.readings);
  return readings;
}

void ExpectSameBits(const std::vector<Readings>& a, const std::vector<Readings>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t v = 0; v < a.size(); ++v) {
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      ASSERT_EQ(a[v][i].kind, b[v][i].kind);
      ASSERT_EQ(a[v][i].range_m, b[v][i].range_m);
      ASSERT_EQ(a[v][i].tick, b[v][i].tick);
      ASSERT_EQ(a[v][i].fired_before_s, b[v][i].fired_before_s);
    }
  }
}

TEST(SonarTiers, NeitherTheOrderOfVehiclesNorTheCutOfTheWorkShows) {
  const ParallelFor last_first = [](std::size_t count, const ParallelBody& body) {
    for (std::size_t end = count; end > 0; end -= std::min<std::size_t>(end, 3)) {
      body(end - std::min<std::size_t>(end, 3), end);
    }
  };
  for (const SonarTier tier :
       {SonarTier::kIdeal, SonarTier::kTypical, SonarTier::kP3dx, SonarTier::kCrosstalk}) {
    const std::vector<Readings> forwards = FleetReadings(tier, false, OnThisThread);
    const std::vector<Readings> backwards = FleetReadings(tier, true, last_first);
    ExpectSameBits(forwards, backwards);
  }
}

TEST(SonarTiers, TheWidthOfTheRegistersDoesNotShow) {
  for (const SonarTier tier :
       {SonarTier::kIdeal, SonarTier::kTypical, SonarTier::kP3dx, SonarTier::kCrosstalk}) {
    const auto plain = FleetReadings(tier, false, OnThisThread, SimdWidth::kPlain);
    for (const SimdWidth width : {SimdWidth::kAvx2, SimdWidth::kAvx512}) {
      if (!HasSimd(width)) continue;
      ExpectSameBits(FleetReadings(tier, false, OnThisThread, width), plain);
    }
  }
}

}  // namespace
}  // namespace giveway::sim
