// Fleets that do not know exactly where they are: with fixes they arrive, without they say that
// they are lost, and an encoder that counts wrongly is noticed.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim_world/virtual/generators.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::sim {
namespace {

constexpr std::uint32_t kSeeds = 2;
constexpr PoseFixModel kFixes = {.every_s = 1, .sigma_m = 0.05, .dropout = 0.1};

struct Fleet {
  double slip = 0;
  PoseFixModel fixes;
  double limit_m = 0;
  WheelErrors errors;
};

Scenario Swarm(std::uint32_t vehicles, std::uint32_t seed, const Fleet& fleet) {
  return MakeSwarm({vehicles, seed, [&](VehicleOptions* options) {
                      options->profile.wheel_slip = fleet.slip;
                      options->profile.encoder_noise = fleet.slip;
                      options->profile.pose_fix = fleet.fixes;
                      options->profile.pose_limit_m = fleet.limit_m;
                      options->profile.wheel_error = fleet.errors;
                    }});
}

std::uint32_t Of(const VirtualOutcome& outcome, Invariant invariant) {
  return outcome.violations[static_cast<std::size_t>(invariant)];
}

TEST(PoseFleet, WithFixesAllArriveWhoseWheelsSlip) {
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const VirtualOutcome outcome = RunVirtually(
        Swarm(6, seed, {.slip = 0.02, .fixes = kFixes, .limit_m = kUsualPoseLimit_m}), {});
    EXPECT_EQ(outcome.arrived, outcome.vehicles) << seed;
    EXPECT_EQ(outcome.contacts, 0U) << seed;
    EXPECT_EQ(Of(outcome, Invariant::kPose), 0U) << seed;
  }
}

TEST(PoseFleet, WithoutFixesTheySayThatTheyAreLost) {
  std::uint32_t lost = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const Scenario scenario = Swarm(6, seed, {.slip = 0.1, .limit_m = kUsualPoseLimit_m});
    const VirtualOutcome outcome = RunVirtually(scenario, {}, [&](const VirtualFleet& fleet) {
      for (std::size_t i = 0; i < fleet.Size(); ++i) {
        const Beacon& said = fleet.OutputsOf(i).beacon;
        lost += said.rule == Rule::kLost && said.tick == fleet.World().Now() ? 1 : 0;
      }
    });
    EXPECT_EQ(outcome.contacts, 0U) << seed;
    EXPECT_EQ(Of(outcome, Invariant::kPose), 0U) << seed;
  }
  EXPECT_GT(lost, 20U);
}

TEST(PoseFleet, UnequalWheelsAreDrivenByWhatFixesShow) {
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const VirtualOutcome outcome = RunVirtually(Swarm(6, seed,
                                                      {.fixes = kFixes,
                                                       .limit_m = kUsualPoseLimit_m,
                                                       .errors = {.diameter = 0.02, .axle = 0.02}}),
                                                {});
    EXPECT_EQ(outcome.arrived, outcome.vehicles) << seed;
    EXPECT_EQ(outcome.contacts, 0U) << seed;
    EXPECT_EQ(Of(outcome, Invariant::kPose), 0U) << seed;
  }
}

VirtualPlan PlanOf(faults::Kind kind, const faults::Parameters& parameters) {
  VirtualPlan plan;
  plan.schedule = {{.rule = "rule",
                    .at_s = 2,
                    .for_s = 20,
                    .kind = kind,
                    .target = {.what = faults::Target::What::kAll},
                    .parameters = parameters}};
  return plan;
}

TEST(PoseFleet, AnEncoderThatCountsWronglyIsNoticedByFixes) {
  const VirtualPlan plan = PlanOf(faults::Kind::kEncoderWrong, {.factor = 1.04});
  std::uint32_t wrong_without = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    wrong_without += Of(RunVirtually(Swarm(6, seed, {}), plan), Invariant::kPose);
    const VirtualOutcome with =
        RunVirtually(Swarm(6, seed, {.fixes = kFixes, .limit_m = kUsualPoseLimit_m}), plan);
    EXPECT_EQ(Of(with, Invariant::kPose), 0U) << seed;
    EXPECT_EQ(with.contacts, 0U) << seed;
  }
  EXPECT_GT(wrong_without, 0U);
}

TEST(PoseFleet, WrongFixesAreNotFollowed) {
  const VirtualPlan plan = PlanOf(faults::Kind::kPoseFixWrong, {.probability = 0.2, .factor = 8});
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const VirtualOutcome outcome = RunVirtually(
        Swarm(6, seed, {.slip = 0.02, .fixes = kFixes, .limit_m = kUsualPoseLimit_m}), plan);
    EXPECT_EQ(Of(outcome, Invariant::kPose), 0U) << seed;
    EXPECT_EQ(outcome.contacts, 0U) << seed;
    EXPECT_EQ(outcome.arrived, outcome.vehicles) << seed;
  }
}

TEST(PoseFleet, WithoutFixesForAWhileTheyAreLostAndGoOnAfterwards) {
  VirtualPlan plan = PlanOf(faults::Kind::kPoseFixLost, {});
  plan.schedule[0].for_s = 40;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const VirtualOutcome outcome = RunVirtually(
        Swarm(6, seed, {.slip = 0.1, .fixes = kFixes, .limit_m = kUsualPoseLimit_m}), plan);
    EXPECT_EQ(outcome.arrived, outcome.vehicles) << seed;
    EXPECT_EQ(outcome.contacts, 0U) << seed;
    EXPECT_EQ(Of(outcome, Invariant::kPose), 0U) << seed;
  }
}

TEST(PoseFleet, RepeatsBitForBit) {
  const Scenario scenario = Swarm(
      6, 3, {.slip = 0.05, .fixes = kFixes, .limit_m = kUsualPoseLimit_m, .errors = {0.01, 0.01}});
  EXPECT_EQ(RunVirtually(scenario, {}).hash, RunVirtually(scenario, {}).hash);
}

}  // namespace
}  // namespace giveway::sim
