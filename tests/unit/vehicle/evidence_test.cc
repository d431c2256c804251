// The evidence that a decision rests on.
#include <gtest/gtest.h>

#include "tests/support/brain_bench.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;

RangeScan RollingScan(double speed_m_s) {
  RangeScan scan = ClearScan(1);
  scan.wheels = WheelsFromTwist(DefaultOptions().profile.drive, {speed_m_s, 0});
  return scan;
}

TEST(Evidence, TellsTheOldestBeaconThatWasDecidedBy) {
  BrainBench bench(OptionsWithoutUltrasonics());
  const auto beacon = [](std::uint32_t tick) { return BeaconOf(2, tick, Pose{{2, 0}, kPi}); };
  bench.Step(RollingScan(0.3), {});
  EXPECT_FALSE(bench.Brain().Evidence().oldest_beacon) << "there is no peer yet";
  bench.Step(RollingScan(0.3), {beacon(1)});
  EXPECT_EQ(bench.Brain().Evidence().oldest_beacon, Nanoseconds{0});
  bench.Step(RollingScan(0.3), {});
  bench.Step(RollingScan(0.3), {});
  EXPECT_EQ(bench.Brain().Evidence().oldest_beacon, milliseconds(100));
  for (int i = 0; i < 5; ++i) bench.Step(RollingScan(0.3), {});
  EXPECT_FALSE(bench.Brain().Evidence().oldest_beacon) << "a stale beacon is not decided by";
}

TEST(Evidence, TellsHowFarIsFreeWhenTheDecisionIsNew) {
  BrainBench bench(DefaultOptions());
  bench.Step(RollingScan(0.3));
  EXPECT_FALSE(bench.Brain().Evidence().free_m);
  RangeScan ahead = RollingScan(0.3);
  SetEcho(&ahead, 3, 0.3);
  SetEcho(&ahead, 4, 0.3);
  const Outputs first = bench.Step(ahead);
  ASSERT_EQ(first.command.decision.rule, Rule::kObstacle);
  const auto free_m = bench.Brain().Evidence().free_m;
  ASSERT_TRUE(free_m);
  EXPECT_GT(*free_m, 0.1);
  EXPECT_LE(*free_m, 0.35);
  const Outputs second = bench.Step(ahead);
  ASSERT_FALSE(second.decision_changed);
  EXPECT_FALSE(bench.Brain().Evidence().free_m) << "reported once, when it is new";
}

TEST(Evidence, TellsTheGapToThePeerThatIsGivenWayTo) {
  VehicleOptions options = OptionsWithoutUltrasonics();
  BrainBench bench(options);
  // From the right, faster, on a crossing path.
  const auto beacon = [](std::uint32_t tick) {
    Beacon made = BeaconOf(2, tick, Pose{{1.2, -1.2}, kPi / 2}, 0.5);
    made.wheels = WheelsFromTwist(made.drive, {0.3, 0});
    return made;
  };
  for (std::uint32_t tick = 1; tick < 40; ++tick) {
    const Outputs said = bench.Step(RollingScan(0.3), {beacon(tick)});
    if (!said.decision_changed || said.command.decision.peer != VehicleId{2}) continue;
    const auto free_m = bench.Brain().Evidence().free_m;
    ASSERT_TRUE(free_m) << Name(said.command.decision.rule);
    EXPECT_GE(*free_m, 0);
    EXPECT_LT(*free_m, 1.8);
    return;
  }
  FAIL() << "it never decided because of the peer";
}

}  // namespace
}  // namespace giveway::test
