// A brain that is told by the roster where it stands.
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::BrainBench;
using test::ClearScan;

RosterEntry Placed(WorldEpoch epoch, Pose start_world) {
  return {.vehicle = VehicleId{1}, .accepted = true, .epoch = epoch, .start_world = start_world};
}

RangeScan ScanOf(WorldEpoch epoch, std::uint32_t tick) {
  RangeScan scan = ClearScan(tick);
  scan.epoch = epoch;
  return scan;
}

TEST(VehicleInARestartedWorld, IsToldWhereItStandsAndDrivesOnFromThere) {
  constexpr WorldEpoch kNext{8};
  constexpr Pose kThere{{4, 5}, 1};
  BrainBench bench(test::DefaultOptions());
  for (int i = 0; i < 5; ++i) bench.Step(ClearScan(0));
  Vehicle brain(test::DefaultOptions(), 42);
  brain.Restore(bench.Brain().State());
  SteadyTime now = bench.Now();
  const auto step = [&](Inputs inputs) {
    now += std::chrono::milliseconds(50);
    inputs.now = now;
    return brain.Step(inputs);
  };
  Outputs out = step({.roster = Placed(kNext, kThere)});
  EXPECT_EQ(out.beacon.world_epoch, kNext);
  EXPECT_EQ(out.beacon.world_from_body, kThere);
  EXPECT_EQ(out.command.target, WheelSpeeds{});  // it has sensed nothing there yet
  EXPECT_EQ(out.command.decision.mode, Mode::kHalt);
  out = step({.scan = ScanOf(kNext, 90)});
  EXPECT_EQ(out.beacon.world_from_body, kThere);
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
  // The old world's last words, and the entry once more, move nothing.
  out = step({.scan = ScanOf(WorldEpoch{7}, 91)});
  EXPECT_EQ(out.beacon.world_epoch, kNext);
  out = step({.roster = Placed(kNext, {})});
  EXPECT_EQ(out.beacon.world_from_body, kThere);
}

TEST(VehicleInARestartedWorld, ARefusalOrAPoseThatIsNoneMovesNothing) {
  Vehicle brain(test::DefaultOptions(), 42);
  RosterEntry entry = Placed(WorldEpoch{8}, {{1, 1}, 0});
  entry.accepted = false;
  brain.Step({.now = std::chrono::milliseconds(50), .roster = entry});
  EXPECT_EQ(brain.State().epoch, kNoEpoch);
  entry = Placed(WorldEpoch{8}, {{std::numeric_limits<double>::quiet_NaN(), 1}, 0});
  brain.Step({.now = std::chrono::milliseconds(100), .roster = entry});
  EXPECT_EQ(brain.State().epoch, kNoEpoch);
}

TEST(VehicleInARestartedWorld, OnAnotherPlaceItDrivesByOtherOptionsAsTheSameVehicle) {
  VehicleOptions options = test::DefaultOptions();
  Vehicle brain(options, 42);
  const Outputs before = brain.Step(
      {.now = std::chrono::milliseconds(50), .roster = Placed(WorldEpoch{8}, {{1, 1}, 0})});
  options.cruise_m_s = options.cruise_m_s + 0.2;
  brain.Reseat(options);
  const Outputs after = brain.Step(
      {.now = std::chrono::milliseconds(100), .roster = Placed(WorldEpoch{8}, {{2, 2}, 0})});
  EXPECT_EQ(after.beacon.boot_epoch, before.beacon.boot_epoch);
  EXPECT_EQ(after.beacon.seq, before.beacon.seq + 1);
  EXPECT_EQ(after.beacon.cruise_m_s, options.cruise_m_s);
  EXPECT_EQ(after.beacon.world_from_body.position_world, (Vec2{2, 2}));
  EXPECT_GT(after.beacon.order.speed_bucket, before.beacon.order.speed_bucket);
}

}  // namespace
}  // namespace giveway
