// A failing run is reduced to what makes it fail, and the file that is left fails by the same
// invariant.
#include "services/fleetctl/virtual/shrink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "services/config/scenario_file.h"
#include "services/config/writing/scenario_rounding.h"
#include "services/config/writing/scenario_write.h"
#include "services/fleetctl/virtual/shrinker.h"
#include "sim_world/virtual/generators.h"

namespace giveway::fleetctl {
namespace {

const ShrinkProgress kGoOn = [](const VirtualCase& /*smallest*/, std::uint32_t /*attempts*/) {
  return true;
};

// Six that drive by wheel rates alone; two of them head on, which ends in a contact.
VirtualCase HeadOnAmongOthers() {
  VirtualCase made;
  made.scenario.name = "head_on";
  made.scenario.duration_s = 60;
  for (std::uint32_t i = 0; i < 6; ++i) {
    VehicleOptions options;
    options.id = VehicleId{i + 1};
    options.profile = PioneerP3dx();
    options.behaviour = Behaviour::kLectureAvoid;
    options.braitenberg = {};  // no weights: straight on
    options.start_world = {.position_world = {0, 12.0 * i}};
    made.scenario.vehicles.push_back(options);
  }
  made.scenario.vehicles[4].start_world = {.position_world = {3.12345, 0}, .heading_rad = 3.14159};
  made.scenario.walls = {{{-5, 20}, {-5, 22}}};
  made.plan.radio.loss = 0.1;
  made.plan.radio.jitter = Nanoseconds(70'000'000);
  made.plan.faults = {
      {.kind = sim::ProcessFaultKind::kPause, .vehicle = VehicleId{1}, .at_s = 50, .for_s = 0.2},
      {.kind = sim::ProcessFaultKind::kPause, .vehicle = VehicleId{3}, .at_s = 1, .for_s = 0.2}};
  return made;
}

TEST(Shrinking, LeavesOnlyTheTwoThatTouch) {
  const auto shrunk = Shrink(HeadOnAmongOthers(), kGoOn);
  ASSERT_TRUE(shrunk);
  const Scenario& left = shrunk->made.scenario;
  ASSERT_EQ(left.vehicles.size(), 2U);
  EXPECT_EQ(left.vehicles[0].id, VehicleId{1});
  EXPECT_EQ(left.vehicles[1].id, VehicleId{5});
  EXPECT_EQ(shrunk->violation.invariant, sim::Invariant::kContact);
  EXPECT_TRUE(left.walls.empty());
  EXPECT_TRUE(shrunk->made.plan.faults.empty());
  EXPECT_EQ(shrunk->made.plan.radio.loss, 0);
  EXPECT_EQ(shrunk->made.plan.radio.jitter, Nanoseconds(0));
  EXPECT_LE(left.duration_s, 12);
  EXPECT_EQ(left.vehicles[1].start_world.position_world.x, 3.123);
}

TEST(Shrinking, TheFileFailsAsTheRunDid) {
  const auto shrunk = Shrink(HeadOnAmongOthers(), kGoOn);
  ASSERT_TRUE(shrunk);
  Scenario scenario = shrunk->made.scenario;
  scenario.vehicles[0].braitenberg = scenario.vehicles[1].braitenberg = LectureWeights();
  const auto before = sim::RunVirtually(scenario, shrunk->made.plan);
  const std::string file =
      testing::TempDir() + "/shrunk_" + std::to_string(getpid()) + ".textproto";
  std::ofstream(file) << WriteScenario(scenario, "left");
  const Scenario read = LoadScenario(file, {});
  std::filesystem::remove(file);
  EXPECT_EQ(sim::RunVirtually(read, shrunk->made.plan).hash, before.hash);
}

// Whatever robots, ultrasonics, errors of wheels and bodies a seed draws: the file is the same run.
class FileOfAGenerator : public testing::TestWithParam<const char*> {};

TEST_P(FileOfAGenerator, IsTheRunThatWasWritten) {
  CaseOptions options{.scenario = GetParam(), .vehicles = WholeRange{4, 4}};
  options.fleet.mixed_robots = true;
  options.fleet.tiers = {SonarTier::kIdeal, SonarTier::kTypical, SonarTier::kP3dx};
  options.fleet.most_slip = 0.02;
  options.fleet.draws_pose_fix = true;
  options.fleet.most_wheel_error = 0.02;
  const CaseMaker maker(options);
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    VirtualCase made = maker.Make(seed);
    made.scenario = Rounded(made.scenario);
    made.scenario.duration_s = 10;
    VirtualCase read{ReadBack(made.scenario), made.plan};
    EXPECT_EQ(read.scenario.seed, 0U);
    read.scenario.seed = made.scenario.seed;
    EXPECT_EQ(sim::RunVirtually(read.scenario, read.plan).hash,
              sim::RunVirtually(made.scenario, made.plan).hash)
        << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, FileOfAGenerator,
                         testing::Values("crossing", "roundabout", "corridor", "swarm", "merge",
                                         "convoy", "warehouse", "door", "one_lane", "antipodal",
                                         "parking", "shared_goal", "mixed_yard"),
                         [](const auto& tested) { return std::string(tested.param); });

// It fails as the file alone: with the draws of seed 0, or with those that it had.
TEST(Shrinking, LeavesAFileThatFailsWithTheDrawsItNames) {
  VirtualCase made = HeadOnAmongOthers();
  made.scenario.seed = 9;
  const auto shrunk = Shrink(made, kGoOn);
  ASSERT_TRUE(shrunk);
  EXPECT_TRUE(shrunk->as_file);
  EXPECT_EQ(shrunk->made.scenario.seed, 0U);
  made.scenario.vehicles[4].profile.wheel_slip = 0.1;
  const auto drawn = Shrink(made, kGoOn);
  ASSERT_TRUE(drawn);
  EXPECT_TRUE(drawn->as_file);
}

// None of these has to do with it.
TEST(Shrinking, LeavesOutBodiesDoorsAndLights) {
  VirtualCase made = HeadOnAmongOthers();
  Scenario& scenario = made.scenario;
  scenario.obstacles = {{.start_world = {{30, 0}, 0}}, {.start_world = {{35, 0}, 0}}};
  scenario.doors = {{.from_world = {40, 0}, .to_world = {41, 0}}};
  scenario.signals = {{.id = SignalId{4}, .line_from_world = {50, -1}, .line_to_world = {50, 1}}};
  scenario.faults = {{.kind = FaultKind::kSignalDark, .at_s = 1, .signal = SignalId{4}}};
  const auto shrunk = Shrink(made, kGoOn);
  ASSERT_TRUE(shrunk);
  const Scenario& left = shrunk->made.scenario;
  EXPECT_EQ(left.vehicles.size(), 2U);
  EXPECT_TRUE(left.obstacles.empty());
  EXPECT_TRUE(left.doors.empty());
  EXPECT_TRUE(left.signals.empty());
  EXPECT_TRUE(left.faults.empty());
}

faults::Fault Scheduled(faults::Kind kind, std::uint32_t vehicle, std::uint32_t nth) {
  return {.rule = "rule",
          .nth = nth,
          .at_s = 0.25 * nth,
          .for_s = 1,
          .kind = kind,
          .target = {.what = faults::Target::What::kVehicle, .vehicle = VehicleId{vehicle}}};
}

// Both would stop for each other; but one has stuck wheels and cannot.
TEST(Shrinking, LeavesOfAScheduleTheFaultThatMatters) {
  VirtualCase made;
  made.scenario = sim::MakeCrossing({6, 3});
  for (std::uint32_t i = 0; i < 20; ++i) {
    made.plan.schedule.push_back(Scheduled(faults::Kind::kLoss, i % 6 + 1, i));
  }
  faults::Fault stuck = Scheduled(faults::Kind::kMotorStuck, 2, 20);
  stuck.for_s = 50;
  made.plan.schedule.push_back(stuck);
  made.plan.schedule.push_back(Scheduled(faults::Kind::kSonarOff, 3, 21));
  const auto shrunk = Shrink(made, kGoOn);
  ASSERT_TRUE(shrunk);
  ASSERT_EQ(shrunk->made.plan.schedule.size(), 1U);
  EXPECT_EQ(shrunk->made.plan.schedule[0], stuck);
}

// A fault needs its target, and a cut of one direction also its sender: with either removed the
// fault is dropped.
TEST(Shrinking, LeavesOutTheFaultsOfWhomItLeavesOut) {
  VirtualCase made = HeadOnAmongOthers();
  faults::Fault cut = Scheduled(faults::Kind::kOneWayCut, 1, 0);
  cut.parameters.from = VehicleId{3};
  made.plan.schedule = {cut, Scheduled(faults::Kind::kLoss, 3, 1)};
  const auto shrunk = Shrink(made, kGoOn);
  ASSERT_TRUE(shrunk);
  EXPECT_EQ(shrunk->made.scenario.vehicles.size(), 2U);
  EXPECT_TRUE(shrunk->made.plan.schedule.empty());
}

TEST(Shrinking, TakesNothingFromARunThatHolds) {
  VirtualCase fine;
  fine.scenario = sim::MakeConvoy({2, 1});
  EXPECT_FALSE(Shrink(fine, kGoOn));
}

// Two break, and another than the first is asked for.
TEST(Shrinking, KeepsTheInvariantThatIsAskedFor) {
  const auto shrunk = Shrink(HeadOnAmongOthers(), kGoOn, sim::Invariant::kClearance);
  ASSERT_TRUE(shrunk);
  EXPECT_EQ(shrunk->violation.invariant, sim::Invariant::kClearance);
  EXPECT_FALSE(Shrink(HeadOnAmongOthers(), kGoOn, sim::Invariant::kRedLight));
}

// Regression: by when vehicles are due depended on the scenario's name, which shrinking changes:
// what it wrote for `delay` did not break that.
TEST(Shrinking, WhatIsLeftOfADelayIsLateUnderAnyName) {
  VirtualCase made = CaseMaker({.scenario = "convoy", .vehicles = WholeRange{3, 3}}).Make(1);
  ASSERT_TRUE(made.plan.through_m);
  const Vec2 goal_world = made.scenario.vehicles[0].goal.at_world;
  const Vec2 across = Left(Forward(made.scenario.vehicles[0].start_world));
  const Vec2 before_world = goal_world - 2 * Forward(made.scenario.vehicles[0].start_world);
  made.scenario.walls = {{before_world - 40 * across, before_world + 40 * across}};
  const auto shrunk = Shrink(made, kGoOn, sim::Invariant::kDelay);
  ASSERT_TRUE(shrunk);
  EXPECT_EQ(shrunk->made.scenario.vehicles.size(), 1U);
  EXPECT_EQ(shrunk->made.plan.through_m, made.plan.through_m);
  Scenario renamed = shrunk->made.scenario;
  renamed.name = "convoy_1";
  const auto outcome = sim::RunVirtually(renamed, shrunk->made.plan);
  EXPECT_EQ(outcome.violations[static_cast<std::size_t>(sim::Invariant::kDelay)], 1U);
  EXPECT_THAT(ReplayFlags(shrunk->made, "f"), testing::HasSubstr(" --through 2 --judge delay"));
}

TEST(Shrinking, StopsWhenItIsToldTo) {
  const auto shrunk =
      Shrink(HeadOnAmongOthers(),
             [](const VirtualCase& /*smallest*/, std::uint32_t attempts) { return attempts < 3; });
  ASSERT_TRUE(shrunk);
  EXPECT_EQ(shrunk->attempts, 3U);
}

TEST(ReplayFlags, NameEverythingThatGoesWrong) {
  VirtualCase made;
  EXPECT_EQ(ReplayFlags(made, "f"), "");
  made.plan.seed = 17;
  made.plan.radio.loss = 0.125;
  made.plan.radio.jitter = Nanoseconds(60'000'000);
  made.plan.faults = {
      {.kind = sim::ProcessFaultKind::kRestart, .vehicle = VehicleId{3}, .at_s = 4.5, .for_s = 0.5},
      {.kind = sim::ProcessFaultKind::kCrash, .vehicle = VehicleId{2}, .at_s = 8}};
  EXPECT_EQ(ReplayFlags(made, "f"),
            " --loss 12.5 --jitter 60 --radio-seed 17 --fault restart:3@4.5+0.5 --fault crash:2@8");
}

// The draws of a fault of the world depend on the seed too.
TEST(ReplayFlags, NameTheFaultFileAndTheSeed) {
  VirtualCase made;
  made.plan.seed = 17;
  made.plan.schedule = {Scheduled(faults::Kind::kSonarGarbage, 1, 0)};
  EXPECT_EQ(ReplayFlags(made, "f"), " --faults f --radio-seed 17");
}

TEST(ReplayFlags, NameWhatIsElseOnlyCounted) {
  VirtualCase made;
  const auto bit = [](sim::Invariant invariant) { return 1U << static_cast<unsigned>(invariant); };
  made.plan.also_required = bit(sim::Invariant::kContact);
  EXPECT_EQ(ReplayFlags(made, "f"), "");
  made.plan.also_required |= bit(sim::Invariant::kClearance) | bit(sim::Invariant::kDelay);
  EXPECT_EQ(ReplayFlags(made, "f"), " --judge clearance,delay");
}

TEST(ReplayFlags, NameTheSeedOfWhatSensorsDraw) {
  VirtualCase made;
  made.scenario.seed = 5;
  EXPECT_EQ(ReplayFlags(made, "f"), " --sensor-seed 5");
}

}  // namespace
}  // namespace giveway::fleetctl
