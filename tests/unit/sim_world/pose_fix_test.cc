// The pose fix sensor: rate, error, drop-outs, and independence from other vehicles; wheels that
// differ from the nominal drive; and faults of fixes.
#include "sim_world/sensors/pose_fix.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/math.h"
#include "sim_world/dynamics/drive.h"
#include "sim_world/run/run.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

constexpr PoseFixModel kEverySecond = {.every_s = 1, .sigma_m = 0.05};

PoseFixMoment At(std::uint32_t tick, std::uint32_t vehicle = 1) {
  return {.seed = 3,
          .vehicle = VehicleId{vehicle},
          .driven_tick = tick,
          .dt_s = 0.05,
          .world_from_body = {{2, -1}, 0.5}};
}

std::uint32_t FixesIn(std::uint32_t ticks, const PoseFixModel& model) {
  std::uint32_t fixes = 0;
  for (std::uint32_t tick = 1; tick <= ticks; ++tick) {
    fixes += SensePose(model, At(tick)).has_value() ? 1 : 0;
  }
  return fixes;
}

TEST(PoseFixSensor, SpeaksAsOftenAsItIsAsked) {
  EXPECT_EQ(FixesIn(2000, kEverySecond), 100U);
  EXPECT_EQ(FixesIn(2000, {.every_s = 0.001, .sigma_m = 1}), 2000U) << "once a tick at most";
  EXPECT_EQ(FixesIn(2000, {}), 0U);
}

TEST(PoseFixSensor, DropsOutAsOftenAsItIsAsked) {
  PoseFixModel model = {.every_s = 0.05, .sigma_m = 1, .dropout = 0.3};
  EXPECT_NEAR(FixesIn(10'000, model) / 10'000.0, 0.7, 0.02);
}

TEST(PoseFixSensor, IsAsWrongAsItSaysAndNoMore) {
  PoseFixModel model = {.every_s = 0.05, .sigma_m = 0.05, .sigma_heading_rad = 0.1};
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0, hh = 0;
  constexpr int kFixes = 20'000;
  for (std::uint32_t tick = 1; tick <= kFixes; ++tick) {
    const auto fix = SensePose(model, At(tick));
    ASSERT_TRUE(fix.has_value());
    const Vec2 off = fix->world_from_body.position_world - Vec2{2, -1};
    const double turned = WrapAngle(fix->world_from_body.heading_rad - 0.5);
    x += off.x / kFixes;
    y += off.y / kFixes;
    xx += off.x * off.x / kFixes;
    yy += off.y * off.y / kFixes;
    xy += off.x * off.y / kFixes;
    hh += turned * turned / kFixes;
  }
  EXPECT_NEAR(x, 0, 0.002);
  EXPECT_NEAR(y, 0, 0.002);
  EXPECT_NEAR(std::sqrt(xx), 0.05, 0.001);
  EXPECT_NEAR(std::sqrt(yy), 0.05, 0.001);
  EXPECT_NEAR(xy, 0, 0.0001);
  EXPECT_NEAR(std::sqrt(hh), 0.1, 0.002);
}

TEST(PoseFixSensor, SaysNothingOfTheHeadingUnlessItCan) {
  for (std::uint32_t tick = 1; tick <= 20; ++tick) {
    if (const auto fix = SensePose(kEverySecond, At(tick))) {
      EXPECT_EQ(fix->sigma_heading_rad, 0);
      EXPECT_EQ(fix->world_from_body.heading_rad, 0);
    }
  }
}

TEST(PoseFixSensor, OfEachVehicleDrawsForItselfAndTakesItsTurn) {
  std::uint32_t together = 0;
  for (std::uint32_t tick = 1; tick <= 200; ++tick) {
    const auto one = SensePose(kEverySecond, At(tick, 1));
    const auto other = SensePose(kEverySecond, At(tick, 2));
    together += one && other ? 1 : 0;
    const auto again = SensePose(kEverySecond, At(tick, 1));
    ASSERT_EQ(one.has_value(), again.has_value());
    if (one) {
      EXPECT_EQ(one->world_from_body, again->world_from_body);
    }
  }
  EXPECT_EQ(together, 0U);
}

Scenario Fitted() {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), VehicleAt(2, {{0, 20}, 0})});
  scenario.vehicles[0].profile.pose_fix = {.every_s = 0.05, .sigma_m = 0.05};
  scenario.duration_s = 1000;
  return scenario;
}

std::vector<PoseFix> FixesOf(const Scenario& scenario, const faults::Schedule& faults, int ticks,
                             std::uint64_t* hash = nullptr) {
  Run run(scenario, kEpoch, OnThisThread, {faults, 1});
  for (const VehicleOptions& options : scenario.vehicles) run.Join(options.id);
  run.Advance({});
  EXPECT_TRUE(run.PoseFixes().empty()) << "before the start nothing moves";
  run.Start();
  std::vector<PoseFix> fixes;
  for (int i = 0; i < ticks; ++i) {
    const MotorCommand commands[] = {Drive(1, run.Now(), 1, 1), Drive(2, run.Now(), 1, 1)};
    run.Advance(commands);
    fixes.insert(fixes.end(), run.PoseFixes().begin(), run.PoseFixes().end());
    for (const PoseFix& fix : run.PoseFixes()) {
      EXPECT_EQ(fix.tick, run.Now());
      EXPECT_EQ(fix.epoch, kEpoch);
    }
  }
  if (hash != nullptr) *hash = run.Hash();
  return fixes;
}

TEST(PoseFixSensor, SpeaksToThoseThatAreFittedAlone) {
  const std::vector<PoseFix> fixes = FixesOf(Fitted(), {}, 50);
  EXPECT_EQ(fixes.size(), 50U);
  for (const PoseFix& fix : fixes) EXPECT_EQ(fix.vehicle, kOne);
}

TEST(PoseFixSensor, ChangesNothingInTheWorld) {
  std::uint64_t with = 0, without = 1;
  FixesOf(Fitted(), {}, 50, &with);
  Scenario plain = Fitted();
  plain.vehicles[0].profile.pose_fix = {};
  FixesOf(plain, {}, 50, &without);
  EXPECT_EQ(with, without);
}

faults::Fault FaultOf(faults::Kind kind, const faults::Parameters& parameters = {}) {
  return {.rule = "rule",
          .at_s = 1,
          .for_s = 1,
          .kind = kind,
          .target = {.what = faults::Target::What::kVehicle, .vehicle = kOne},
          .parameters = parameters};
}

TEST(PoseFixFault, LostFixesDoNotComeForItsTime) {
  EXPECT_EQ(FixesOf(Fitted(), {FaultOf(faults::Kind::kPoseFixLost)}, 100).size(), 80U);
}

TEST(PoseFixFault, WrongFixesAreOffByTheirMultipleForItsTime) {
  const auto wrong = FaultOf(faults::Kind::kPoseFixWrong, {.probability = 1, .factor = 8});
  const std::vector<PoseFix> sound = FixesOf(Fitted(), {}, 100);
  const std::vector<PoseFix> fixes = FixesOf(Fitted(), {wrong}, 100);
  ASSERT_EQ(fixes.size(), sound.size());
  int off = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const double off_m =
        Norm(fixes[i].world_from_body.position_world - sound[i].world_from_body.position_world);
    EXPECT_TRUE(off_m == 0 || std::abs(off_m - 0.4) < 1e-12) << i;
    off += off_m > 0 ? 1 : 0;
  }
  EXPECT_EQ(off, 20);
}

TEST(PoseFixFault, OfSomeHitsSome) {
  const auto wrong = FaultOf(faults::Kind::kPoseFixWrong, {.probability = 0.5, .factor = 8});
  const std::vector<PoseFix> sound = FixesOf(Fitted(), {}, 100);
  const std::vector<PoseFix> fixes = FixesOf(Fitted(), {wrong}, 100);
  int off = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    off += fixes[i].world_from_body == sound[i].world_from_body ? 0 : 1;
  }
  EXPECT_GT(off, 3);
  EXPECT_LT(off, 17);
}

// One leg of Borenstein's bidirectional square path: unequal wheels bend a straight path.
TEST(WheelErrors, UnequalWheelsBendAStraightWay) {
  RobotModel profile = PioneerP3dx();
  profile.wheel_error.diameter = 0.02;
  const Rolled rolled = Roll(profile, {4, 4}, Random(1));
  EXPECT_EQ(rolled.encoders, (WheelSpeeds{4, 4}));
  const Twist twist = TwistFromWheels(profile.drive, rolled.ground);
  EXPECT_NEAR(twist.forward_m_s, 4 * profile.drive.wheel_radius_m, 1e-12);
  EXPECT_NEAR(twist.turn_rad_s, 0.02 * 4 * profile.drive.wheel_radius_m / profile.drive.axle_m,
              1e-12);
}

TEST(WheelErrors, ALongerAxleTurnsLess) {
  RobotModel profile = PioneerP3dx();
  profile.wheel_error.axle = 0.1;
  const Twist said = TwistFromWheels(profile.drive, {3, 4});
  const Twist twist = TwistFromWheels(profile.drive, Roll(profile, {3, 4}, Random(1)).ground);
  EXPECT_NEAR(twist.forward_m_s, said.forward_m_s, 1e-12);
  EXPECT_NEAR(twist.turn_rad_s, said.turn_rad_s / 1.1, 1e-12);
}

TEST(WheelErrors, DrawTheSameSlipAsWithoutThem) {
  RobotModel profile = PioneerP3dx();
  profile.wheel_slip = 0.1;
  profile.encoder_noise = 0.1;
  const Rolled plain = Roll(profile, {3, 4}, Random(1));
  profile.wheel_error.diameter = 0.02;
  const Rolled rolled = Roll(profile, {3, 4}, Random(1));
  EXPECT_EQ(rolled.encoders, plain.encoders);
  EXPECT_NEAR(rolled.ground.right_rad_s, 1.01 * plain.ground.right_rad_s, 1e-12);
  EXPECT_NEAR(rolled.ground.left_rad_s, 0.99 * plain.ground.left_rad_s, 1e-12);
}

}  // namespace
}  // namespace giveway::sim
