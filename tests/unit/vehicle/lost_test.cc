// A vehicle that does not know its pose well enough slows down, halts and says so; others take it
// for an obstacle and do not wait for what its beacon says.
#include <gtest/gtest.h>

#include "services/types/math/math.h"
#include "services/vehicle/situation/claim.h"
#include "services/vehicle/situation/situation.h"
#include "tests/support/brain_bench.h"
#include "tests/support/onlooker.h"

namespace giveway {
namespace {

using test::BrainBench;
using test::ClearScan;

VehicleOptions Slipping() {
  VehicleOptions options = test::DefaultOptions();
  options.goal.at_world = {100, 0};
  options.profile.wheel_slip = 0.1;
  options.profile.pose_fix = {.every_s = 1, .sigma_m = 0.05};
  options.profile.pose_limit_m = kUsualPoseLimit_m;
  return options;
}

RangeScan Rolling(double rad_s) {
  RangeScan scan = ClearScan(0);
  scan.wheels = {rad_s, rad_s};
  return scan;
}

// Drives until it stands and names the rule, for a minute at most.
Outputs UntilLost(BrainBench* bench, bool* slowed = nullptr) {
  Outputs out;
  for (int i = 0; i < 1200 && out.command.decision.rule != Rule::kLost; ++i) {
    out = bench->Step(Rolling(3));
    if (slowed != nullptr && out.command.decision.rule == Rule::kUnsure) *slowed = true;
  }
  return out;
}

TEST(Lost, OneThatGrowsUnsureSlowsDownThenHaltsAndSaysSo) {
  BrainBench bench(Slipping());
  bool slowed = false;
  const Outputs out = UntilLost(&bench, &slowed);
  EXPECT_TRUE(slowed);
  ASSERT_EQ(out.command.decision.rule, Rule::kLost);
  EXPECT_EQ(out.command.decision.mode, Mode::kHalt);
  EXPECT_EQ(out.beacon.rule, Rule::kLost);
  EXPECT_EQ(out.beacon.toward_world, out.beacon.world_from_body.position_world);
  EXPECT_EQ(bench.Step(Rolling(0)).command.target, WheelSpeeds{});
}

TEST(Lost, OneThatIsUnsureSaysAllTheSameThatALightStopsIt) {
  BrainBench bench(Slipping());
  Outputs out;
  for (int i = 0; i < 1200 && out.command.decision.rule != Rule::kUnsure; ++i) {
    out = bench.Step(Rolling(3));
  }
  ASSERT_EQ(out.command.decision.rule, Rule::kUnsure);
  const double line_m = out.beacon.world_from_body.position_world.x + 2.5;
  bench.WithNext().signals = {{.id = SignalId{1},
                               .epoch = test::kEpoch,
                               .tick = out.beacon.tick,
                               .line_from_world = {line_m, 1},
                               .line_to_world = {line_m, -1},
                               .phase = SignalPhase::kRed,
                               .to_change_s = 5}};
  EXPECT_EQ(bench.Step(Rolling(3)).beacon.rule, Rule::kSignal);
}

// These behaviours ignore how well the pose is known; without any known pose the vehicle stands.
TEST(Lost, TheLecturesBehavioursHaltToo) {
  for (const Behaviour behaviour : {Behaviour::kLectureAvoid, Behaviour::kStockAvoid,
                                    Behaviour::kLectureYield, Behaviour::kLecturePrinted}) {
    VehicleOptions options = Slipping();
    options.behaviour = behaviour;
    BrainBench bench(options);
    bool slowed = false;
    const Outputs out = UntilLost(&bench, &slowed);
    EXPECT_FALSE(slowed);
    EXPECT_EQ(out.command.decision.rule, Rule::kLost) << static_cast<int>(behaviour);
    EXPECT_EQ(out.command.decision.mode, Mode::kHalt);
    EXPECT_EQ(bench.Step(Rolling(0)).command.target, WheelSpeeds{});
  }
}

TEST(Lost, ItGoesOnWhenAFixComes) {
  BrainBench bench(Slipping());
  const Outputs lost = UntilLost(&bench);
  ASSERT_EQ(lost.command.decision.rule, Rule::kLost);
  ASSERT_EQ(bench.Step(Rolling(0)).command.decision.rule, Rule::kLost);
  PoseFix fix{.world_from_body = lost.beacon.world_from_body,
              .sigma_position_m = 0.05,
              .vehicle = VehicleId{1},
              .epoch = test::kEpoch,
              .tick = lost.beacon.tick};
  fix.world_from_body.position_world.y += 0.2;
  bench.WithNext().pose_fix = fix;
  const Outputs out = bench.Step(Rolling(0));
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
  EXPECT_NEAR(out.beacon.world_from_body.position_world.y,
              lost.beacon.world_from_body.position_world.y + 0.2, 0.05);
}

TEST(Lost, WithoutALimitItNeverIs) {
  VehicleOptions options = Slipping();
  options.profile.pose_limit_m = 0;
  BrainBench bench(options);
  EXPECT_EQ(UntilLost(&bench).command.decision.rule, Rule::kCruise);
}

// The same peer on a crossing path, from the right and faster: once driving, once lost.
Rule RuleBefore(Rule peers_rule) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  Rule rule = Rule::kCruise;
  for (std::uint32_t tick = 1; tick < 40; ++tick) {
    Beacon peer = test::BeaconOf(2, tick, {{1.1, -0.8}, kPi / 2}, 0.5);
    peer.rule = peers_rule;
    rule = bench.Step(Rolling(0), {peer}).command.decision.rule;
  }
  return rule;
}

TEST(Lost, NobodyWaitsForTheWordOfOneThatIs) {
  EXPECT_TRUE(IsGiveWay(RuleBefore(Rule::kCruise)));
  EXPECT_FALSE(IsGiveWay(RuleBefore(Rule::kLost)));
}

// It may stand off the place that its beacon states.
TEST(Lost, OneThatIsIsPassedAsFarAwayAsItIsUnsure) {
  const auto room_m = [](Rule rule) {
    const test::Onlooker onlooker;
    Peer peer = test::PeerAt({{3, 0}, 0}, {.xx_m2 = 0.09, .yy_m2 = 0.09});
    peer.beacon.rule = rule;
    return RoomBeside(onlooker.RelatePeer(&peer), onlooker.Own());
  };
  EXPECT_NEAR(room_m(Rule::kLost), room_m(Rule::kArrived) + kSigmas * 0.3, 1e-9);
}

// A fix that shows that it is not at its goal makes it drive on.
TEST(Lost, OneThatArrivedByItsWheelsGoesOnWhenAFixShowsThatItIsElsewhere) {
  VehicleOptions options = Slipping();
  options.goal.at_world = {1, 0};
  BrainBench bench(options);
  Outputs out;
  for (int i = 0; i < 100 && out.command.decision.rule != Rule::kArrived; ++i)
    out = bench.Step(Rolling(3));
  ASSERT_EQ(out.command.decision.rule, Rule::kArrived);
  for (int i = 0; i < 8; ++i) {  // so many are believed against the wheels
    ASSERT_EQ(out.command.decision.rule, Rule::kArrived) << i;
    bench.WithNext().pose_fix = PoseFix{.world_from_body = {{0.8, 0.05}, 0},
                                        .sigma_position_m = 0.01,
                                        .vehicle = VehicleId{1},
                                        .epoch = test::kEpoch,
                                        .tick = out.beacon.tick};
    out = bench.Step(Rolling(0));
  }
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
  // Approaches measured by its wheels alone do not count: it has yet to come nearer.
  const VehicleState& state = bench.Brain().State();
  EXPECT_LE(state.progress.no_progress_ticks, 1U);
  EXPECT_GT(state.progress.nearest_m, 0.1);
}

}  // namespace
}  // namespace giveway
