// A brain that gets its pose from the roster, and one that takes over from the process before.
#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>
#include <memory>

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
  EXPECT_EQ(out.beacon.world_epoch, kNoEpoch);  // it has sensed nothing there yet
  EXPECT_EQ(out.command.epoch, kNext);
  EXPECT_EQ(out.beacon.world_from_body, kThere);
  EXPECT_EQ(out.command.target, WheelSpeeds{});
  EXPECT_EQ(out.command.decision.mode, Mode::kHalt);
  out = step({.scan = ScanOf(kNext, 90)});
  EXPECT_EQ(out.beacon.world_epoch, kNext);
  EXPECT_EQ(out.beacon.world_from_body, kThere);
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
  // The old world's last samples, and the entry once more, change nothing.
  out = step({.scan = ScanOf(WorldEpoch{7}, 91)});
  EXPECT_EQ(out.beacon.world_epoch, kNext);
  out = step({.roster = Placed(kNext, {})});
  EXPECT_EQ(out.beacon.world_from_body, kThere);
}

TEST(VehicleInARestartedWorld, DoubtsItsUltrasonicsNoLonger) {
  Vehicle before(test::DefaultOptions(), 42);
  before.Step({.now = std::chrono::milliseconds(50), .roster = Placed(WorldEpoch{7}, {})});
  auto state = std::make_unique<VehicleState>(before.State());
  state->sensed.doubt = {ScanNews::kLeaps, 7};
  Vehicle brain(test::DefaultOptions(), 42);
  brain.Restore(*state);
  EXPECT_EQ(brain.State().sensed.doubt.ticks, 7U);
  brain.Step({.now = std::chrono::milliseconds(100), .roster = Placed(WorldEpoch{8}, {})});
  EXPECT_EQ(brain.State().sensed.doubt.ticks, 0U);
}

TEST(VehicleInARestartedWorld, ARefusalOrAPoseThatIsNoneMovesNothing) {
  Vehicle brain(test::DefaultOptions(), 42);
  RosterEntry entry = Placed(WorldEpoch{8}, {{1, 1}, 0});
  entry.accepted = false;
  brain.Step({.now = std::chrono::milliseconds(50), .roster = entry});
  EXPECT_EQ(brain.State().world.epoch, kNoEpoch);
  entry = Placed(WorldEpoch{8}, {{std::numeric_limits<double>::quiet_NaN(), 1}, 0});
  brain.Step({.now = std::chrono::milliseconds(100), .roster = entry});
  EXPECT_EQ(brain.State().world.epoch, kNoEpoch);
}

// Its beacons would be refused by every peer, and it would find no path by such a heading.
TEST(VehicleInARestartedWorld, AHeadingOfMoreThanATurnMovesNothing) {
  for (const double heading_rad : {3.15, -3.15, 1e9}) {
    Vehicle brain(test::DefaultOptions(), 42);
    brain.Step({.now = std::chrono::milliseconds(50),
                .roster = Placed(WorldEpoch{8}, {{1, 1}, heading_rad})});
    EXPECT_EQ(brain.State().world.epoch, kNoEpoch) << heading_rad;
  }
  Vehicle brain(test::DefaultOptions(), 42);
  brain.Step(
      {.now = std::chrono::milliseconds(50), .roster = Placed(WorldEpoch{8}, {{1, 1}, kPi})});
  EXPECT_EQ(brain.State().world.epoch, WorldEpoch{8});
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

// A vehicle that drives round a square with wheel errors, so that its position is uncertain.
class Rounds {
 public:
  static constexpr WorldEpoch kWorld{8};

  Rounds() : options(test::DefaultOptions()) {
    options.goal.set = false;
    options.route = {
        .waypoints_world = {{{2, 0}, {2, 2}, {0, 2}, {0, 0}}}, .count = 4, .loop = true};
    options.profile.wheel_slip = 0.02;
  }

  // The next scan, of wheels that do as commanded.
  RangeScan Scan(WheelSpeeds wheels) {
    RangeScan scan = ScanOf(kWorld, ++tick);
    scan.wheels = wheels;
    counted = CountOn(counted, wheels, 0.05);
    scan.counted = counted;
    return scan;
  }
  Outputs Step(Vehicle* brain, const RangeScan& scan) {
    return brain->Step({.now = Number(scan.tick) * options.tick_period, .scan = scan});
  }
  // Through the first corner and some distance on.
  Vehicle UnderWay() {
    Vehicle brain(options, 42);
    brain.Step({.now = Nanoseconds{0}, .roster = Placed(kWorld, {})});
    WheelSpeeds wheels;
    while (brain.State().route.waypoint < 1 || tick < 200) {
      wheels = Step(&brain, Scan(wheels)).command.target;
    }
    last = wheels;
    return brain;
  }

  VehicleOptions options;
  std::uint32_t tick = 0;
  WheelAngles counted;
  WheelSpeeds last;
};

TEST(VehicleThatRestarts, GoesOnAlongItsRouteFromWhereItBelievedToBe) {
  Rounds rounds;
  Vehicle before = rounds.UnderWay();
  const auto handover = before.HandOver();
  ASSERT_TRUE(handover.has_value());
  EXPECT_EQ(handover->task.waypoint, 1U);
  EXPECT_GT(handover->covariance.yy_m2, 0);
  Vehicle after(rounds.options, 43);
  ASSERT_TRUE(after.TakeOver(*handover));
  // An answer that the world gave to the process before changes nothing.
  RosterEntry old = Placed(Rounds::kWorld, {});
  after.Step({.now = rounds.tick * rounds.options.tick_period, .roster = old});
  EXPECT_EQ(after.HandOver(), handover);
  // It kept rolling while no process steered it: the encoder count says how far.
  Outputs is;
  Outputs should_be;
  for (int i = 0; i < 10; ++i) {
    const RangeScan scan = rounds.Scan(rounds.last);
    should_be = rounds.Step(&before, scan);
    if (i == 9) is = rounds.Step(&after, scan);
  }
  EXPECT_LT(Norm(is.beacon.world_from_body.position_world -
                 should_be.beacon.world_from_body.position_world),
            0.01);
  EXPECT_GE(SigmaPosition(is.beacon.covariance), SigmaPosition(should_be.beacon.covariance));
  EXPECT_EQ(is.beacon.toward_world, (Vec2{2, 2}));
  EXPECT_EQ(is.command.task, should_be.command.task);
  EXPECT_EQ(is.beacon.boot_epoch, 43U);  // to its peers it is another life
}

TEST(VehicleThatRestarts, KeepsWhatItHasWaitedAndItsPlaceInTheOrder) {
  const Rounds rounds;
  Vehicle brain(rounds.options, 42);
  const auto limit =
      static_cast<std::uint32_t>(rounds.options.ageing_limit / rounds.options.tick_period);
  Handover handover{.epoch = Rounds::kWorld, .tick = Tick{5000}, .task = {2, limit + 7}};
  ASSERT_TRUE(brain.TakeOver(handover));
  EXPECT_EQ(brain.State().waiting.order.waited_ticks, limit);
  EXPECT_EQ(brain.HandOver(), handover);
  handover.task = {5, 5001};  // neither has the route so many, nor the world lasted so long
  ASSERT_TRUE(brain.TakeOver(handover));
  EXPECT_EQ(brain.HandOver()->task, TaskProgress{});
}

// It had waited for longer than 0 ticks, which its beacon of tick 0 could not have.
TEST(VehicleThatRestarts, IsRefusedByNoneForWhatItHasWaited) {
  const Rounds rounds;
  Vehicle brain(rounds.options, 42);
  const auto limit =
      static_cast<std::uint32_t>(rounds.options.ageing_limit / rounds.options.tick_period);
  ASSERT_TRUE(
      brain.TakeOver({.epoch = Rounds::kWorld, .tick = Tick{5000}, .task = {2, limit + 7}}));
  const Beacon beacon = brain.Step({}).beacon;
  EXPECT_EQ(beacon.tick, kNoTick);
  EXPECT_EQ(beacon.world_epoch, kNoEpoch);
  EXPECT_EQ(beacon.order.waited_ticks, limit);
  PeerTable peers;
  BeaconCounters counters;
  TrustCounters trust;
  peers.Take(test::Received(beacon, {}), {VehicleId{9}, Rounds::kWorld, Tick{5002}, {}},
             rounds.options, &counters, &trust);
  EXPECT_EQ(counters.not_heard, 1U);
  EXPECT_EQ(counters.Rejected(), 0U);
}

TEST(VehicleThatRestarts, TakesOverNothingThatIsNotSound) {
  const Rounds rounds;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Handover good{.epoch = Rounds::kWorld, .tick = Tick{9}};
  for (const auto& spoil : std::initializer_list<void (*)(Handover&)>{
           [](Handover& h) { h.epoch = kNoEpoch; }, [](Handover& h) { h.tick = kNoTick; },
           [](Handover& h) { h.counted.left_rad = kNan; },
           [](Handover& h) { h.world_from_body.position_world.x = kNan; },
           [](Handover& h) { h.world_from_body.heading_rad = 7; },
           [](Handover& h) { h.covariance.xx_m2 = -1; },
           [](Handover& h) { h.covariance.xy_m2 = 1; }}) {
    Handover bad = good;
    spoil(bad);
    Vehicle brain(rounds.options, 42);
    EXPECT_FALSE(brain.TakeOver(bad));
    EXPECT_FALSE(brain.HandOver().has_value());
  }
  EXPECT_TRUE(IsSound(good));
}

TEST(VehicleThatRestarts, GoesByTheWorldWhereItsBodyWasPutElsewhereMeanwhile) {
  const Handover own{.epoch = WorldEpoch{8}, .tick = Tick{50}, .counted = {3, 3}};
  RosterEntry entry = Placed(WorldEpoch{8}, {});
  entry.tick = Tick{40};  // of the time before
  EXPECT_TRUE(IsOfTheSameBody(own, entry));
  entry.tick = Tick{60};
  EXPECT_FALSE(IsOfTheSameBody(own, entry));  // one that has never moved
  entry.counted = {3.5, 3.5};
  EXPECT_TRUE(IsOfTheSameBody(own, entry));
  entry.epoch = WorldEpoch{9};
  EXPECT_FALSE(IsOfTheSameBody(own, entry));
}

// As after kill -9: the new process knows nothing, and the body may still roll.
TEST(VehicleThatRestarts, IsToldByTheWorldWhereItIsAndHowFarAndCarriesItOnToItsFirstScan) {
  Rounds rounds;
  Vehicle before = rounds.UnderWay();
  RosterEntry entry = Placed(Rounds::kWorld, before.HandOver()->world_from_body);
  entry.tick = Tick{rounds.tick};
  entry.counted = rounds.counted;
  entry.task = before.HandOver()->task;
  RangeScan scan;
  Outputs should_be;
  for (int i = 0; i < 6; ++i) should_be = rounds.Step(&before, scan = rounds.Scan(rounds.last));
  Vehicle after(rounds.options, 43);
  const Outputs is = after.Step(
      {.now = Number(scan.tick) * rounds.options.tick_period, .scan = scan, .roster = entry});
  EXPECT_LT(Norm(is.beacon.world_from_body.position_world -
                 should_be.beacon.world_from_body.position_world),
            0.005);
  EXPECT_GT(Norm(is.beacon.world_from_body.position_world - entry.start_world.position_world),
            0.05);
  EXPECT_GT(SigmaPosition(is.beacon.covariance), 0);
  EXPECT_EQ(is.beacon.toward_world, should_be.beacon.toward_world);
}

TEST(VehicleThatRestarts, StandsBeforeItGoesAndIsHeardUntilThen) {
  Rounds rounds;
  Vehicle brain = rounds.UnderWay();
  EXPECT_FALSE(brain.Stands());
  const RangeScan rolling = rounds.Scan(rounds.last);
  const Outputs said = brain.Step(
      {.now = Number(rolling.tick) * rounds.options.tick_period, .scan = rolling, .halting = true});
  EXPECT_EQ(said.command.target, WheelSpeeds{});
  EXPECT_EQ(said.command.decision.rule, Rule::kLeaving);
  EXPECT_EQ(said.beacon.mode, Mode::kCooperative);  // no leave notice: it is still there
  EXPECT_FALSE(brain.Stands());
  const RangeScan standing = rounds.Scan({});
  brain.Step({.now = Number(standing.tick) * rounds.options.tick_period,
              .scan = standing,
              .halting = true});
  EXPECT_TRUE(brain.Stands());
}

}  // namespace
}  // namespace giveway
