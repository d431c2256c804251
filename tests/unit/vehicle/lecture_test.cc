// The printed scripts and their one variable, with one brain on the bench. Their effect in a fleet:
// tests/golden/lecture_printed_test.cc.
#include "services/vehicle/decision/lecture.h"

#include <gtest/gtest.h>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;

// A peer that drives at that speed, with a beacon in this tick's step.
Beacon Drives(std::uint32_t id, std::uint32_t tick, double speed_m_s) {
  Beacon beacon = BeaconOf(id, tick, {.position_world = {0, 1.0 + id}}, speed_m_s);
  beacon.wheels = {speed_m_s / 0.0975, speed_m_s / 0.0975};
  return beacon;
}

VehicleOptions Printed() {
  VehicleOptions options = test::DefaultOptions();
  options.behaviour = Behaviour::kLecturePrinted;
  return options;
}

// A scan of a vehicle that drives at that speed, and of something 0.6 m ahead.
RangeScan EchoAt(double speed_m_s) {
  RangeScan scan = ClearScan(0);
  scan.wheels = {speed_m_s / 0.0975, speed_m_s / 0.0975};
  test::SetEcho(&scan, 3, 0.6);
  return scan;
}

TEST(PrintedScript, TheFasterOneDrivesOn) {
  BrainBench bench(Printed());
  bench.Step(ClearScan(1));
  const Outputs out = bench.Step(EchoAt(0.3), {Drives(2, 1, 0.29)});
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
}

TEST(PrintedScript, TheSlowerOneCopiesTheWheelsOfThePeer) {
  BrainBench bench(Printed());
  bench.Step(ClearScan(1));
  const Beacon faster = Drives(2, 1, 0.31);
  const Outputs out = bench.Step(EchoAt(0.3), {faster});
  EXPECT_EQ(out.command.decision.rule, Rule::kGiveWay);
  EXPECT_EQ(out.command.decision.peer, VehicleId{2});
  EXPECT_EQ(out.command.decision.sensor, 3);
  EXPECT_EQ(out.command.target, faster.wheels);
}

TEST(PrintedScript, OfTwoThatAreEquallyFastEitherCopies) {
  BrainBench bench(Printed());
  bench.Step(ClearScan(1));
  EXPECT_EQ(bench.Step(EchoAt(0.3), {Drives(2, 1, 0.3)}).command.decision.rule, Rule::kGiveWay);
}

TEST(PrintedScript, WithoutAnEchoInTheGateItNeverCompares) {
  BrainBench bench(Printed());
  bench.Step(ClearScan(1));
  RangeScan scan = EchoAt(0.3);
  test::SetEcho(&scan, 3, 1.0);
  EXPECT_EQ(bench.Step(scan, {Drives(2, 1, 0.9)}).command.decision.rule, Rule::kCruise);
}

TEST(PrintedScript, OfThoseHeardAtOneTimeTheLastOneStays) {
  BrainBench bench(Printed());
  bench.Step(ClearScan(1));
  const Outputs out = bench.Step(EchoAt(0.3), {Drives(3, 1, 0.4), Drives(2, 1, 0.5)});
  EXPECT_EQ(out.command.decision.peer, VehicleId{3});
}

TEST(PrintedScript, WhoSpokeLastIsBelievedAfterTheTableForgotIt) {
  BrainBench bench(Printed());
  bench.Step(ClearScan(1));
  bench.Step(ClearScan(2), {Drives(2, 1, 0.4)});
  for (int i = 0; i < 31 * 20; ++i) bench.Step(ClearScan(0));
  const Outputs out = bench.Step(EchoAt(0.3));
  EXPECT_EQ(out.command.decision.rule, Rule::kGiveWay);
  EXPECT_EQ(out.command.decision.peer, VehicleId{2});
}

TEST(PrintedScript, StopsWhereEveryBehaviourStops) {
  BrainBench bench(Printed());
  bench.Step(EchoAt(0));
  Outputs out;
  for (int i = 0; i < 5; ++i) out = bench.StepBlind();
  EXPECT_EQ(out.command.decision.rule, Rule::kRangesStale);
  RangeScan waiting = EchoAt(0);
  waiting.run_state = RunState::kWaiting;
  EXPECT_EQ(bench.Step(waiting).command.decision.rule, Rule::kNotRunning);
}

}  // namespace
}  // namespace giveway
