// Faults of ultrasonics, motors and encoders: the effect of each in numbers, that it ends with the
// fault, that it repeats, and that a schedule without faults changes no bit.
#include "sim_world/faults/world_faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "sim_world/run/run.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

using faults::Kind;

constexpr double kAt_s = 1;
constexpr double kFor_s = 1;
constexpr std::uint32_t kBegins = 20;  // the driving tick, and the first after it
constexpr std::uint32_t kEnds = 40;

// A vehicle in front of a wall that its front ultrasonics detect, with wheels that turn as
// commanded.
Scenario BeforeAWall() {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), VehicleAt(2, {{0, 20}, 0})});
  scenario.walls = {{{4, -6}, {4, 6}}, {{4, 14}, {4, 26}}};
  scenario.duration_s = 1000;
  return scenario;
}

faults::Fault FaultAt(Kind kind, double at_s = kAt_s, double for_s = kFor_s) {
  return {.rule = "rule",
          .at_s = at_s,
          .for_s = for_s,
          .kind = kind,
          .target = {.what = faults::Target::What::kVehicle, .vehicle = kOne}};
}

faults::Fault FaultAtAll(Kind kind) {
  faults::Fault fault = FaultAt(kind);
  fault.target = {.what = faults::Target::What::kAll};
  return fault;
}

// A run in which all vehicles drive at 1 rad/s, and a fault-free one to compare with.
class SideBySide {
 public:
  explicit SideBySide(faults::Schedule schedule, std::uint64_t seed = 1,
                      Scenario scenario = BeforeAWall())
      : faulty(scenario, kEpoch, OnThisThread, {std::move(schedule), seed}),
        sound(scenario, kEpoch) {
    for (sim::Run* run : {&faulty, &sound}) {
      run->Join(kOne);
      run->Join(kTwo);
      run->Start();
    }
  }
  void Advance(std::uint32_t ticks) {
    for (std::uint32_t i = 0; i < ticks; ++i) {
      for (sim::Run* run : {&faulty, &sound}) {
        run->Advance(
            std::vector{Drive(1, run->Now(), rad_s, rad_s), Drive(2, run->Now(), rad_s, rad_s)});
      }
      events.insert(events.end(), faulty.Events().begin(), faulty.Events().end());
    }
  }
  // To the tick of that number since the start.
  void AdvanceTo(std::uint32_t tick) { Advance(tick - Number(faulty.Now())); }
  const RangeScan& Faulty(std::size_t i = 0) const { return faulty.Scans()[i]; }
  const RangeScan& Sound(std::size_t i = 0) const { return sound.Scans()[i]; }
  std::vector<WorldEvent> Of(EventKind kind) const {
    std::vector<WorldEvent> found;
    std::ranges::copy_if(events, std::back_inserter(found),
                         [&](const WorldEvent& event) { return event.kind == kind; });
    return found;
  }

  double rad_s = 1;
  sim::Run faulty;
  sim::Run sound;
  std::vector<WorldEvent> events;
};

bool SameReading(const RangeReading& a, const RangeReading& b) {
  return a.kind == b.kind && a.range_m == b.range_m && a.tick == b.tick &&
         a.fired_before_s == b.fired_before_s;
}

bool SameReadings(const RangeScan& a, const RangeScan& b) {
  return std::equal(a.readings.begin(), a.readings.end(), b.readings.begin(), SameReading);
}

std::ptrdiff_t EchoCount(const RangeScan& scan) {
  return std::ranges::count(scan.readings, Echo::kEcho, &RangeReading::kind);
}

// Faults of ultrasonics have no effect before and after their time, on other vehicles, or on
// wheels.
class SonarFaultTest : public testing::TestWithParam<Kind> {};

TEST_P(SonarFaultTest, IsThereForItsTimeAndItsVehicleOnly) {
  faults::Fault fault = FaultAt(GetParam());
  fault.parameters.period_s = 0.5;
  fault.parameters.delay_s = 0.5;
  SideBySide pair({fault});
  bool differed = false;
  for (std::uint32_t tick = 1; tick <= 60; ++tick) {
    pair.AdvanceTo(tick);
    ASSERT_TRUE(SameReadings(pair.Faulty(1), pair.Sound(1))) << tick;
    ASSERT_EQ(pair.Faulty().wheels, pair.Sound().wheels);
    ASSERT_EQ(pair.Faulty().counted, pair.Sound().counted);
    const bool under_way = tick >= kBegins && tick < kEnds;
    ASSERT_TRUE(under_way || SameReadings(pair.Faulty(), pair.Sound())) << tick;
    differed = differed || !SameReadings(pair.Faulty(), pair.Sound());
  }
  EXPECT_TRUE(differed);
  EXPECT_EQ(pair.faulty.Hash(), pair.sound.Hash());
}

INSTANTIATE_TEST_SUITE_P(AllKinds, SonarFaultTest,
                         testing::Values(Kind::kSonarOff, Kind::kSonarStuck, Kind::kSonarGarbage,
                                         Kind::kSonarWrong, Kind::kSonarSlow, Kind::kSonarDelayed,
                                         Kind::kSonarIntermittent));

TEST(SonarFault, OffIsClearUnderTheTimesOfItsFirings) {
  SideBySide pair({FaultAt(Kind::kSonarOff)});
  pair.AdvanceTo(kBegins);
  ASSERT_GT(EchoCount(pair.Sound()), 0);
  EXPECT_EQ(EchoCount(pair.Faulty()), 0);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const RangeReading& sound = pair.Sound().readings[i];
    EXPECT_EQ(pair.Faulty().readings[i].tick, sound.tick);
    const Echo expected = sound.kind == Echo::kNoData ? Echo::kNoData : Echo::kClear;
    EXPECT_EQ(pair.Faulty().readings[i].kind, expected);
  }
}

TEST(SonarFault, StuckSaysOnAndOnWhatItSaidAndThatItFiredNow) {
  SideBySide pair({FaultAt(Kind::kSonarStuck)});
  pair.AdvanceTo(kBegins);
  EXPECT_TRUE(SameReadings(pair.Faulty(), pair.Sound()));
  const RangeScan first = pair.Faulty();
  pair.AdvanceTo(kEnds - 1);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    EXPECT_EQ(pair.Faulty().readings[i].range_m, first.readings[i].range_m);
    EXPECT_EQ(pair.Faulty().readings[i].tick, pair.Sound().readings[i].tick);
  }
}

TEST(SonarFault, GarbageIsInReachAndNewForEachFiring) {
  SideBySide pair({FaultAt(Kind::kSonarGarbage)});
  pair.AdvanceTo(kBegins - 1);
  std::vector<double> ranges;
  for (std::uint32_t tick = kBegins; tick < kEnds; ++tick) {
    pair.AdvanceTo(tick);
    for (const RangeReading& reading : pair.Faulty().readings) {
      if (reading.kind == Echo::kEcho) ranges.push_back(reading.range_m);
    }
  }
  // Eight transducers in 20 ticks: three quarters of them.
  EXPECT_NEAR(static_cast<double>(ranges.size()), 120, 25);
  EXPECT_GE(std::ranges::min(ranges), 0);
  EXPECT_LE(std::ranges::max(ranges), 5);
  EXPECT_LT(std::ranges::min(ranges), 0.5);
  EXPECT_GT(std::ranges::max(ranges), 4.5);
  std::ranges::sort(ranges);
  EXPECT_EQ(std::ranges::adjacent_find(ranges), ranges.end());
}

TEST(SonarFault, WrongMultipliesAndIsClearBeyondReach) {
  faults::Fault fault = FaultAt(Kind::kSonarWrong);
  fault.parameters.factor = 1.25;
  SideBySide pair({fault});
  pair.AdvanceTo(kBegins);
  bool beyond = false;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const RangeReading& sound = pair.Sound().readings[i];
    if (sound.kind != Echo::kEcho) continue;
    const RangeReading& faulty = pair.Faulty().readings[i];
    if (1.25 * sound.range_m <= 5) {
      EXPECT_DOUBLE_EQ(faulty.range_m, 1.25 * sound.range_m);
    } else {
      EXPECT_EQ(faulty.kind, Echo::kClear);
      beyond = true;
    }
  }
  EXPECT_TRUE(beyond);
}

TEST(SonarFault, SlowChangesOnceAPeriodAndSaysHowOldItIs) {
  faults::Fault fault = FaultAt(Kind::kSonarSlow);
  fault.parameters.period_s = 0.25;
  SideBySide pair({fault});
  pair.AdvanceTo(kBegins - 1);
  RangeScan last = pair.Sound();
  for (std::uint32_t tick = kBegins; tick < kEnds; ++tick) {
    pair.AdvanceTo(tick);
    if ((tick - kBegins) % 5 == 0) last = pair.Sound();
    EXPECT_TRUE(SameReadings(pair.Faulty(), last)) << tick;
  }
}

TEST(SonarFault, DelayedSaysWhatWasOfThatLongAgo) {
  faults::Fault fault = FaultAt(Kind::kSonarDelayed);
  fault.parameters.delay_s = 0.2;
  SideBySide pair({fault});
  pair.AdvanceTo(kBegins - 1);
  std::vector<RangeScan> said;
  for (std::uint32_t tick = kBegins; tick < kEnds; ++tick) {
    pair.AdvanceTo(tick);
    said.push_back(pair.Sound());
    const std::size_t i = said.size() - 1;
    EXPECT_TRUE(SameReadings(pair.Faulty(), said[i < 4 ? 0 : i - 4])) << tick;
  }
}

TEST(SonarFault, IntermittentLosesItsShareOfWholeScans) {
  faults::Fault fault = FaultAt(Kind::kSonarIntermittent, 1, 100);
  fault.parameters.probability = 0.3;
  SideBySide pair({fault});
  pair.rad_s = 0;
  pair.AdvanceTo(kBegins - 1);
  int lost = 0;
  for (int i = 0; i < 1000; ++i) {
    pair.Advance(1);
    const bool is_lost = EchoCount(pair.Faulty()) == 0;
    ASSERT_TRUE(is_lost || SameReadings(pair.Faulty(), pair.Sound()));
    lost += is_lost ? 1 : 0;
  }
  EXPECT_NEAR(lost, 300, 60);
}

// Each vehicle draws its own values from a schedule for all.
TEST(SonarFault, OfAllMeetsEverybody) {
  SideBySide pair({FaultAtAll(Kind::kSonarGarbage)});
  pair.AdvanceTo(kBegins);
  EXPECT_FALSE(SameReadings(pair.Faulty(0), pair.Sound(0)));
  EXPECT_FALSE(SameReadings(pair.Faulty(1), pair.Sound(1)));
  EXPECT_FALSE(SameReadings(pair.Faulty(0), pair.Faulty(1)));
  ASSERT_EQ(pair.Of(EventKind::kFaultBegan).size(), 1U);
  EXPECT_EQ(pair.Of(EventKind::kFaultBegan)[0].vehicle, kNoVehicle);
}

TEST(SonarFault, RepeatsFromItsSeedRuleAndNumber) {
  const auto ranges = [](const faults::Fault& fault, std::uint64_t seed) {
    SideBySide pair({fault}, seed);
    pair.AdvanceTo(kBegins);
    return pair.Faulty();
  };
  const faults::Fault fault = FaultAt(Kind::kSonarGarbage);
  faults::Fault second = fault;
  second.nth = 1;
  faults::Fault other = fault;
  other.rule = "other";
  EXPECT_TRUE(SameReadings(ranges(fault, 1), ranges(fault, 1)));
  EXPECT_FALSE(SameReadings(ranges(fault, 1), ranges(fault, 2)));
  EXPECT_FALSE(SameReadings(ranges(fault, 1), ranges(second, 1)));
  EXPECT_FALSE(SameReadings(ranges(fault, 1), ranges(other, 1)));
}

// Nor on how long the world waited for its vehicles.
TEST(SonarFault, DrawsCountFromTheStart) {
  const FaultSchedule schedule{{FaultAt(Kind::kSonarGarbage), FaultAtAll(Kind::kSonarIntermittent)},
                               1};
  const auto readings = [&](int waited) {
    sim::Run run(BeforeAWall(), kEpoch, OnThisThread, schedule);
    run.Join(kOne);
    run.Join(kTwo);
    for (int i = 0; i < waited; ++i) run.Advance({});
    run.Start();
    std::vector<double> ranges;
    for (std::uint32_t tick = 1; tick < kEnds; ++tick) {
      run.Advance({});
      for (const RangeScan& scan : run.Scans()) {
        for (const RangeReading& reading : scan.readings) ranges.push_back(reading.range_m);
      }
    }
    return ranges;
  };
  EXPECT_EQ(readings(0), readings(37));
}

TEST(DriveFault, WeakWheelsReachTheirPartAndAllOfItAfterwards) {
  faults::Fault fault = FaultAt(Kind::kMotorWeak);
  fault.parameters.factor = 0.5;
  SideBySide pair({fault});
  pair.AdvanceTo(kEnds - 1);
  EXPECT_DOUBLE_EQ(pair.faulty.Truths()[0].wheels.left_rad_s, 0.5);
  EXPECT_DOUBLE_EQ(pair.Faulty().wheels.right_rad_s, 0.5);
  EXPECT_DOUBLE_EQ(pair.faulty.Truths()[1].wheels.left_rad_s, 1);
  pair.AdvanceTo(kEnds + 10);
  EXPECT_DOUBLE_EQ(pair.faulty.Truths()[0].wheels.left_rad_s, 1);
}

// Neither a command nor a missing one stops it; its end does.
TEST(DriveFault, StuckWheelsTurnOnWhateverIsCommanded) {
  SideBySide pair({FaultAt(Kind::kMotorStuck)});
  pair.AdvanceTo(kBegins - 1);
  pair.rad_s = 0;
  pair.AdvanceTo(kEnds - 1);
  EXPECT_DOUBLE_EQ(pair.faulty.Truths()[0].wheels.left_rad_s, 1);
  EXPECT_DOUBLE_EQ(pair.Faulty().wheels.left_rad_s, 1);
  EXPECT_EQ(pair.faulty.Truths()[1].wheels.left_rad_s, 0);
  pair.AdvanceTo(kEnds + 10);
  EXPECT_EQ(pair.faulty.Truths()[0].wheels.left_rad_s, 0);
}

TEST(DriveFault, StuckAtRestStandsWhateverIsCommanded) {
  SideBySide pair({FaultAt(Kind::kMotorStuck)});
  pair.rad_s = 0;
  pair.AdvanceTo(kBegins);
  pair.rad_s = 1;
  pair.AdvanceTo(kEnds - 1);
  EXPECT_EQ(pair.faulty.Truths()[0].wheels.left_rad_s, 0);
}

TEST(DriveFault, WrongEncodersCountTheirMultipleWithoutAJump) {
  faults::Fault fault = FaultAt(Kind::kEncoderWrong);
  fault.parameters.factor = 1.5;
  SideBySide pair({fault});
  for (std::uint32_t tick = 1; tick <= 60; ++tick) {
    const double before_rad = tick == 1 ? 0 : pair.Faulty().counted.left_rad;
    pair.AdvanceTo(tick);
    const double factor = tick >= kBegins && tick < kEnds ? 1.5 : 1;
    EXPECT_DOUBLE_EQ(pair.Faulty().wheels.left_rad_s, factor * pair.Sound().wheels.left_rad_s);
    EXPECT_NEAR(pair.Faulty().counted.left_rad - before_rad,
                0.05 * factor * pair.Sound().wheels.left_rad_s, 1e-12);
  }
  EXPECT_EQ(pair.faulty.Truths()[0].world_from_body, pair.sound.Truths()[0].world_from_body);
  EXPECT_NEAR(pair.Faulty().counted.left_rad - pair.Sound().counted.left_rad, 0.5, 1e-9);
}

TEST(WorldFaults, BeginAndEndAreEventsOfTheTicksTheyAreIn) {
  faults::Fault fault = FaultAt(Kind::kMotorWeak);
  fault.nth = 3;
  SideBySide pair({fault});
  pair.AdvanceTo(60);
  const auto begun = pair.Of(EventKind::kFaultBegan);
  const auto over = pair.Of(EventKind::kFaultOver);
  ASSERT_EQ(begun.size(), 1U);
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(begun[0].tick, Tick{kBegins});
  EXPECT_EQ(begun[0].vehicle, kOne);
  EXPECT_EQ(begun[0].text, "motor_weak 3 of rule");
  EXPECT_EQ(over[0].tick, Tick{kEnds});
  EXPECT_EQ(over[0].text, begun[0].text);
}

TEST(WorldFaults, OneShorterThanATickLastsATick) {
  SideBySide pair({FaultAt(Kind::kSonarOff, 1.01, 0.01)});
  pair.AdvanceTo(21);
  EXPECT_EQ(EchoCount(pair.Faulty()), 0);
  pair.AdvanceTo(22);
  EXPECT_TRUE(SameReadings(pair.Faulty(), pair.Sound()));
  EXPECT_EQ(pair.Of(EventKind::kFaultBegan).size(), 1U);
  EXPECT_EQ(pair.Of(EventKind::kFaultOver).size(), 1U);
}

// A fault that never affected a vehicle is not reported as having happened.
TEST(WorldFaults, OfAVehicleThatIsNotThereNeverBegins) {
  faults::Fault fault = FaultAt(Kind::kSonarOff);
  fault.target.vehicle = VehicleId{9};
  SideBySide pair({fault});
  pair.AdvanceTo(60);
  EXPECT_TRUE(pair.Of(EventKind::kFaultBegan).empty());
  EXPECT_TRUE(pair.Of(EventKind::kFaultOver).empty());
}

TEST(WorldFaults, TwoAtOnceBothDoTheirPart) {
  faults::Fault weak = FaultAt(Kind::kMotorWeak);
  weak.parameters.factor = 0.5;
  faults::Fault encoder = FaultAt(Kind::kEncoderWrong);
  encoder.parameters.factor = 1.5;
  SideBySide pair({weak, encoder, FaultAt(Kind::kSonarOff)});
  pair.AdvanceTo(kEnds - 1);
  EXPECT_DOUBLE_EQ(pair.Faulty().wheels.left_rad_s, 0.75);
  EXPECT_EQ(EchoCount(pair.Faulty()), 0);
}

TEST(WorldFaults, OthersFaultsAreNoneOfItsBusiness) {
  SideBySide pair({FaultAt(Kind::kLoss), FaultAt(Kind::kPause), FaultAt(Kind::kSpoofed)});
  for (std::uint32_t tick = 1; tick <= 60; ++tick) {
    pair.AdvanceTo(tick);
    ASSERT_TRUE(SameReadings(pair.Faulty(), pair.Sound()));
  }
  EXPECT_TRUE(pair.Of(EventKind::kFaultBegan).empty());
  EXPECT_EQ(pair.faulty.Hash(), pair.sound.Hash());
}

TEST(WorldFaults, NoneIsAtWorkBeforeTheStart) {
  sim::Run run(BeforeAWall(), kEpoch, OnThisThread, {{FaultAt(Kind::kSonarOff, 0, 1000)}, 1});
  run.Join(kOne);
  run.Join(kTwo);
  run.Advance({});
  EXPECT_GT(EchoCount(run.Scans()[0]), 0);
  run.Start();
  run.Advance({});
  EXPECT_EQ(EchoCount(run.Scans()[0]), 0);
}

// A checkpoint during the fault: the restored world drives on with the wheels stuck at the same
// speed, whatever they did while it waited, and does not report the start of the fault again.
TEST(WorldFaults, AreThereAgainInARestoredRun) {
  const FaultSchedule schedule{{FaultAt(Kind::kMotorStuck), FaultAt(Kind::kSonarOff)}, 1};
  SideBySide pair(schedule.faults);
  pair.AdvanceTo(30);
  sim::Run restored(BeforeAWall(), WorldEpoch{8}, OnThisThread, schedule);
  const FleetCheckpoint saved{.run = pair.faulty.Save()};
  ASSERT_TRUE(restored.Restore(std::get<FleetCheckpoint>(FromBytes(ToBytes(saved))).run, {}));
  for (int i = 0; i < 20; ++i) restored.Advance({});
  EXPECT_EQ(restored.Truths()[0].wheels, WheelSpeeds{});
  EXPECT_GT(EchoCount(restored.Scans()[0]), 0);
  restored.Start();
  std::vector<WorldEvent> events;
  const auto advance = [&] {
    restored.Advance({});
    events.insert(events.end(), restored.Events().begin(), restored.Events().end());
  };
  advance();
  EXPECT_EQ(restored.Truths()[0].wheels, (WheelSpeeds{1, 1}));
  EXPECT_EQ(EchoCount(restored.Scans()[0]), 0);
  for (std::uint32_t tick = 32; tick <= kEnds; ++tick) advance();
  EXPECT_LT(restored.Truths()[0].wheels.left_rad_s, 1);
  EXPECT_GT(EchoCount(restored.Scans()[0]), 0);
  EXPECT_EQ(std::ranges::count(events, EventKind::kFaultBegan, &WorldEvent::kind), 0);
  EXPECT_EQ(std::ranges::count(events, EventKind::kFaultOver, &WorldEvent::kind), 2);
}

TEST(WorldFaults, ACheckpointOfAnotherScheduleIsRefused) {
  SideBySide pair({FaultAt(Kind::kMotorStuck)});
  pair.AdvanceTo(30);
  sim::Run without(BeforeAWall(), WorldEpoch{8});
  EXPECT_FALSE(without.Restore(pair.faulty.Save(), {}));
}

// After more than a second without commands, the run still waits for a vehicle stopped by a planned
// fault.
TEST(PlannedSilence, OfAPausedVehicleDoesNotEndAClosedRun) {
  SideBySide pair({FaultAt(Kind::kPause)});
  pair.AdvanceTo(10);
  for (int i = 0; i < 30; ++i) pair.faulty.Advance(std::vector{Drive(2, pair.faulty.Now(), 1, 1)});
  EXPECT_EQ(pair.faulty.State(), RunState::kRunning);
  pair.faulty.Advance(
      std::vector{Drive(1, pair.faulty.Now(), 1, 1), Drive(2, pair.faulty.Now(), 1, 1)});
  EXPECT_EQ(std::ranges::count(pair.faulty.Events(), EventKind::kJoined, &WorldEvent::kind), 1);
  pair.faulty.Advance(
      std::vector{Drive(1, pair.faulty.Now(), 1, 1), Drive(2, pair.faulty.Now(), 1, 1)});
  EXPECT_GT(pair.faulty.Truths()[0].wheels.left_rad_s, 0);
}

TEST(PlannedSilence, OfAKilledVehicleIsForGood) {
  const PlannedSilence silence({FaultAt(Kind::kKill, 3, 0), FaultAt(Kind::kLoss)});
  EXPECT_FALSE(silence.VehiclesReturn());
  EXPECT_FALSE(silence.IsKilled(kOne, 2.9));
  EXPECT_TRUE(silence.IsKilled(kOne, 3));
  EXPECT_FALSE(silence.IsKilled(kTwo, 3));
}

}  // namespace
}  // namespace giveway::sim
