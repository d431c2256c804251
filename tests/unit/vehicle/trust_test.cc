// Each kind of contradiction between a peer's beacons and the own sensors, and what only looks like
// one.
#include "services/vehicle/estimation/trust.h"

#include <gtest/gtest.h>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;

// Stands ahead of the own vehicle, which stands at the origin and looks east.
Beacon Ahead(std::uint32_t tick, double away_m = 3) {
  return BeaconOf(2, tick, {.position_world = {away_m, 0}, .heading_rad = kPi / 2});
}

// Both sensors that point ahead detect a body whose centre is at that distance.
RangeScan HearingAhead(double away_m) {
  const SensorMount mount = PioneerP3dx().sonar[3];
  RangeScan scan = ClearScan(0);
  const Vec2 to = Vec2{away_m, 0} - mount.position_body;
  for (const int sensor : {3, 4}) test::SetEcho(&scan, sensor, Norm(to) - 0.25);
  return scan;
}

class Trust : public testing::Test {
 protected:
  // One tick with a beacon of the tick before.
  void Hear(const RangeScan& scan, Beacon beacon) {
    beacon.tick = Tick{bench_.NextTick() - 1};
    beacon.seq = bench_.NextTick() - 1;
    out_ = bench_.Step(scan, beacon.seq == 0 ? std::vector<Beacon>{} : std::vector{beacon});
  }
  void HearFor(int ticks, const RangeScan& scan, const Beacon& beacon) {
    for (int i = 0; i < ticks; ++i) Hear(scan, beacon);
  }
  void Begin(const VehicleOptions& options) { bench_ = BrainBench(options); }

  const TrustCounters& Counted() const { return bench_.Brain().State().counters.trust; }
  Mode TheMode() const { return out_.command.decision.mode; }
  bool Doubted() const {
    return IsDoubted(bench_.Brain().State().heard.peers.Peers()[0].trust, bench_.Now());
  }

  BrainBench bench_{test::DefaultOptions()};
  Outputs out_;
};

// ---- a beacon without its echo

using BeaconWithoutEcho = Trust;

TEST_F(BeaconWithoutEcho, IsCountedWhenItBeginsAndLowersTheLadder) {
  HearFor(5, ClearScan(0), Ahead(0));
  EXPECT_EQ(Counted().beacon_without_echo, 0U);
  HearFor(10, ClearScan(0), Ahead(0));
  EXPECT_EQ(Counted().beacon_without_echo, 1U);
  EXPECT_EQ(Counted().Total(), 1U);
  EXPECT_TRUE(Doubted());
  EXPECT_EQ(TheMode(), Mode::kSensorOnly);
}

TEST_F(BeaconWithoutEcho, IsNoneWhereTheBodyIsHeard) {
  HearFor(20, HearingAhead(3), Ahead(0));
  EXPECT_EQ(Counted().Total(), 0U);
  EXPECT_EQ(TheMode(), Mode::kCooperative);
}

TEST_F(BeaconWithoutEcho, IsNoneWhereSomethingNearerHidesTheBody) {
  HearFor(20, HearingAhead(1), Ahead(0));
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(BeaconWithoutEcho, IsOneWhereOnlySomethingFartherIsHeard) {
  HearFor(20, HearingAhead(4), Ahead(0));
  EXPECT_EQ(Counted().beacon_without_echo, 1U);
}

TEST_F(BeaconWithoutEcho, IsNoneOutOfEveryCone) {
  HearFor(20, ClearScan(0), Ahead(0, -3));
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(BeaconWithoutEcho, IsNoneOfOneThatIsNotSureWhereItIs) {
  Beacon unsure = Ahead(0);
  unsure.covariance = {.xx_m2 = 0.09, .yy_m2 = 0.09};
  HearFor(20, ClearScan(0), unsure);
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(BeaconWithoutEcho, IsNoneBeyondWhatTheUltrasonicsHear) {
  VehicleOptions options = test::DefaultOptions();
  options.profile.sonar_max_range_m = 2.5;
  Begin(options);
  HearFor(20, ClearScan(0), Ahead(0));
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(BeaconWithoutEcho, AccusesNobodyWhereUltrasonicsMissThings) {
  VehicleOptions options = test::DefaultOptions();
  options.sonar_noise = 0.01;
  Begin(options);
  HearFor(20, ClearScan(0), Ahead(0));
  EXPECT_EQ(Counted().beacon_without_echo, 1U);
  EXPECT_EQ(TheMode(), Mode::kCooperative);
}

// ---- neither beacon nor echo

class SilentPeer : public Trust {
 protected:
  // Heard by both senses at that distance, then by the ultrasonics alone for so many ticks.
  void FallSilent(double away_m, int ticks = 0) {
    HearFor(10, HearingAhead(away_m), Ahead(0, away_m));
    StepOn(HearingAhead(away_m), ticks);
  }
  void StepOn(const RangeScan& scan, int ticks) {
    for (int i = 0; i < ticks; ++i) out_ = bench_.Step(scan);
  }
  void DriveOn(RangeScan scan, int ticks) {
    scan.wheels = test::Rolling(0.3);
    StepOn(scan, ticks);
  }
  void BeginWithNoise() {
    VehicleOptions options = test::DefaultOptions();
    options.sonar_noise = 0.01;
    Begin(options);
  }
  static RangeScan Everywhere(double range_m) {
    RangeScan scan = ClearScan(0);
    for (int i = 0; i < 8; ++i) test::SetEcho(&scan, i, range_m);
    return scan;
  }
  void Leap(int ticks, WheelSpeeds wheels = {}) {
    for (int i = 0; i < ticks; ++i) {
      RangeScan scan = Everywhere(i % 2 == 0 ? 1 : 3);
      scan.wheels = wheels;
      StepOn(scan, 1);
    }
  }
  bool Halts() const {
    return out_.command.decision.rule == Rule::kRangesStale &&
           out_.command.decision.peer == VehicleId{2} && TheMode() == Mode::kHalt;
  }
};

TEST_F(SilentPeer, WhoMustBeHeardAndIsNotShowsThatTheUltrasonicsAreOff) {
  FallSilent(1);
  StepOn(ClearScan(0), 5);
  EXPECT_FALSE(Halts());
  StepOn(ClearScan(0), 10);
  EXPECT_TRUE(Halts());
  StepOn(ClearScan(0), 200);
  EXPECT_TRUE(Halts()) << "by then it may be elsewhere, but the ultrasonics are off";
}

TEST_F(SilentPeer, IsDrivenPastOnceUltrasonicsHearAnything) {
  FallSilent(1);
  StepOn(ClearScan(0), 20);
  ASSERT_TRUE(Halts());
  RangeScan wall = ClearScan(0);
  test::SetEcho(&wall, 0, 4);
  StepOn(wall, 6);
  EXPECT_FALSE(Halts());
}

// As in a corridor: most sensors leap, then the vehicle stands and they hear the same.
TEST_F(SilentPeer, IsDrivenPastOnceMostSensorsHearAgain) {
  FallSilent(1);
  StepOn(ClearScan(0), 20);
  ASSERT_TRUE(Halts());
  StepOn(Everywhere(2), 6);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, NeedNotBeHeardOnceItMayHaveDrivenOff) {
  FallSilent(1, 80);
  StepOn(ClearScan(0), 50);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, NeedNotBeHeardOnceItMayHaveBeenTakenAway) {
  FallSilent(3, 100);
  StepOn(ClearScan(0), 50);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, ChangesNothingForTheLecturesBehaviours) {
  VehicleOptions options = test::DefaultOptions();
  options.behaviour = Behaviour::kLectureYield;
  Begin(options);
  FallSilent(1);
  StepOn(ClearScan(0), 50);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, NeedNotBeHeardBesideTheCones) {
  HearFor(10, ClearScan(0), Ahead(0, -1));
  StepOn(ClearScan(0), 50);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, NeedNotBeHeardWhereUltrasonicsMissThings) {
  BeginWithNoise();
  FallSilent(1);
  StepOn(ClearScan(0), 50);
  EXPECT_FALSE(Halts());
}

// Heard by the ultrasonics alone for two seconds, so that it need not be ahead any more.
TEST_F(SilentPeer, WhoseEchoVanishesFromAmidConesShowsThatTheUltrasonicsAreOff) {
  FallSilent(1, 50);
  EXPECT_FALSE(Halts());
  StepOn(ClearScan(0), 1);
  EXPECT_TRUE(Halts());
}

TEST_F(SilentPeer, MayBeElsewhereThanWhatVanishes) {
  HearFor(10, HearingAhead(1), Ahead(0, -4));
  StepOn(HearingAhead(1), 20);
  StepOn(ClearScan(0), 20);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, IsNotWhereOneThatLeavesVanishes) {
  HearFor(10, HearingAhead(2), Ahead(0, -2));
  Beacon leaving = BeaconOf(3, 0, {.position_world = {2, 0}});
  HearFor(15, HearingAhead(2), leaving);
  leaving.mode = Mode::kLeaving;
  Hear(HearingAhead(2), leaving);
  StepOn(ClearScan(0), 20);
  EXPECT_FALSE(Halts());
}

// A world takes bodies away.
TEST_F(SilentPeer, WhoseEchoVanishesLateMayHaveBeenTakenAway) {
  FallSilent(1, 100);
  StepOn(ClearScan(0), 20);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, WhileEchoesStayTheSameAndTheVehicleDrivesShowsThatTheyAreStuck) {
  FallSilent(2, 20);
  DriveOn(HearingAhead(2), 3);
  StepOn(HearingAhead(2), 10);
  EXPECT_FALSE(Halts()) << "it stands, and so may all around it";
  DriveOn(HearingAhead(2), 4);
  EXPECT_FALSE(Halts());
  DriveOn(HearingAhead(2), 1);
  EXPECT_TRUE(Halts());
  StepOn(HearingAhead(2), 50);
  EXPECT_TRUE(Halts()) << "it stands for it";
  StepOn(ClearScan(0), 10);
  EXPECT_FALSE(Halts());
}

// The foot of the perpendicular keeps its distance.
TEST_F(SilentPeer, WhileAWallToTheSideStaysAsFarShowsNothing) {
  FallSilent(2, 20);
  RangeScan wall = ClearScan(0);
  test::SetEcho(&wall, 0, 1);
  DriveOn(wall, 30);
  EXPECT_FALSE(Halts());
  wall.wheels = {-3, 3};
  StepOn(wall, 10);
  EXPECT_TRUE(Halts()) << "not from one that turns";
}

// Noise makes no two readings alike.
TEST_F(SilentPeer, WhileEchoesStayTheSameShowsItOfUltrasonicsThatMissThingsToo) {
  BeginWithNoise();
  FallSilent(2);
  DriveOn(HearingAhead(2), 20);
  EXPECT_TRUE(Halts());
}

TEST_F(SilentPeer, WhoSpokeInBetweenMustBeShownUnheardAgain) {
  FallSilent(2);
  DriveOn(HearingAhead(2), 20);
  ASSERT_TRUE(Halts());
  HearFor(10, HearingAhead(2), Ahead(0, 2));
  EXPECT_FALSE(Halts());
  StepOn(HearingAhead(2), 20);
  EXPECT_FALSE(Halts()) << "now it stands";
}

TEST_F(SilentPeer, IsNotNearWhereEchoesStayTheSame) {
  VehicleOptions options = test::DefaultOptions();
  options.emission_radius_m = 20;
  Begin(options);
  HearFor(10, HearingAhead(2), Ahead(0, -8));
  DriveOn(HearingAhead(2), 20);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, WhileMostEchoesLeapShowsThatTheyAreRandom) {
  FallSilent(2, 10);
  Leap(4);
  EXPECT_FALSE(Halts());
  Leap(6);
  EXPECT_TRUE(Halts());
  StepOn(Everywhere(3.05), 1);
  EXPECT_TRUE(Halts()) << "random readings look right now and then";
  StepOn(Everywhere(3.05), 6);
  EXPECT_FALSE(Halts());
}

// Corners come and go before the sensors of one that turns.
TEST_F(SilentPeer, WhileEchoesLeapShowsNothingToOneThatTurns) {
  FallSilent(2, 10);
  Leap(20, {-3, 3});
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, WhileEchoesLeapShowsNothingOfUltrasonicsThatMissThings) {
  BeginWithNoise();
  FallSilent(2, 10);
  Leap(30);
  EXPECT_FALSE(Halts());
}

// While it spoke, they missed it.
TEST_F(SilentPeer, WasNotHeardBeforeByUltrasonicsThatMissThings) {
  BeginWithNoise();
  HearFor(20, ClearScan(0), Ahead(0, 2));
  StepOn(ClearScan(0), 20);
  EXPECT_FALSE(Halts());
}

// ---- an echo without a beacon

TEST_F(Trust, AMoverNobodySpeaksForIsCountedWhenItBegins) {
  for (int i = 0; i < 20; ++i) {
    RangeScan scan = ClearScan(0);
    test::SetEcho(&scan, 1, 1.1 - 0.03 * i);
    bench_.Step(scan);
  }
  EXPECT_EQ(Counted().echo_without_beacon, 1U);
  EXPECT_EQ(Counted().Total(), 1U);
}

// ---- says it stands, and comes nearer

class SaysItStands : public Trust {
 protected:
  // Detected where its beacon says, standing, then nearer by so much a tick; its beacon follows by
  // `follows`.
  void ComeNearer(double by_m, int ticks, bool follows) {
    HearFor(30, HearingAhead(2.5), Ahead(0, 2.5));
    for (int i = 1; i <= ticks; ++i) {
      Hear(HearingAhead(2.5 - by_m * i), Ahead(0, follows ? 2.5 - by_m * i : 2.5));
    }
  }
};

TEST_F(SaysItStands, AndComesNearerIsCountedAndLowersTheLadder) {
  ComeNearer(0.015, 16, true);
  EXPECT_EQ(Counted().halted_but_closing, 1U);
  EXPECT_EQ(Counted().Total(), 1U);
  EXPECT_TRUE(Doubted());
  EXPECT_EQ(TheMode(), Mode::kSensorOnly);
}

TEST_F(SaysItStands, ComesNearerForAMomentAndIsNotHeldToIt) {
  ComeNearer(0.015, 8, true);
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(SaysItStands, OrSaysThatItDrives) {
  HearFor(30, HearingAhead(2.5), Ahead(0, 2.5));
  for (int i = 1; i < 30; ++i) {
    Beacon beacon = Ahead(0, 2.5 - 0.015 * i);
    beacon.wheels = {0.3 / 0.0975, 0.3 / 0.0975};
    beacon.acceleration_m_s2 = 20;
    beacon.world_from_body.heading_rad = kPi;
    Hear(HearingAhead(2.5 - 0.015 * i), beacon);
  }
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(SaysItStands, AndTheOwnVehicleDrivesUpToIt) {
  HearFor(30, HearingAhead(2.5), Ahead(0, 2.5));
  for (int i = 1; i < 40; ++i) {
    RangeScan scan = HearingAhead(2.5 - 0.015 * i);
    scan.wheels = {0.3 / 0.0975, 0.3 / 0.0975};
    Hear(scan, Ahead(0, 2.5));
  }
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(SaysItStands, AndAnotherMayBeWhoComesNearer) {
  for (int i = 1; i < 60; ++i) {
    const double away_m = 2.5 - (i < 30 ? 0 : 0.015 * (i - 30));
    const std::uint32_t tick = bench_.NextTick() - 1;
    Beacon other = BeaconOf(3, tick, {.position_world = {away_m, 0}, .heading_rad = kPi});
    other.wheels = {0.3 / 0.0975, 0.3 / 0.0975};
    const std::vector<Beacon> both = {Ahead(tick, 2.5), other};
    bench_.Step(HearingAhead(away_m), tick == 0 ? std::vector<Beacon>{} : both);
  }
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(SaysItStands, AndOneThatFellSilentMayBeWhoComesNearer) {
  Hear(ClearScan(0), Ahead(0, 2.5));
  bench_.Step(HearingAhead(2.5), {BeaconOf(3, 1, {.position_world = {-4, 0}})});
  ComeNearer(0.015, 16, false);
  EXPECT_EQ(Counted().Total(), 0U);
}

// Its shell is within radio range, its centre is not.
TEST_F(SaysItStands, AndOneOutOfReachOfTheRadioComesNearer) {
  VehicleOptions options = test::DefaultOptions();
  options.emission_radius_m = 2.6;
  Begin(options);
  ComeNearer(0.015, 16, false);
  EXPECT_EQ(Counted().Total(), 0U);
}

// ---- jumps and speeds, from beacon to beacon

class FromBeaconToBeacon : public Trust {
 protected:
  FromBeaconToBeacon() { Begin(test::OptionsWithoutUltrasonics()); }
};

TEST_F(FromBeaconToBeacon, AJumpIsCountedAndDoubtedForAWhile) {
  HearFor(5, ClearScan(0), Ahead(0, 3));
  EXPECT_EQ(Counted().Total(), 0U);
  Hear(ClearScan(0), Ahead(0, 4));
  EXPECT_EQ(Counted().jumps, 1U);
  EXPECT_EQ(Counted().Total(), 1U);
  EXPECT_EQ(TheMode(), Mode::kSensorOnly);
  HearFor(39, ClearScan(0), Ahead(0, 4));
  EXPECT_EQ(TheMode(), Mode::kSensorOnly);
  HearFor(2, ClearScan(0), Ahead(0, 4));
  EXPECT_EQ(TheMode(), Mode::kCooperative);
  EXPECT_EQ(Counted().Total(), 1U);
}

TEST_F(FromBeaconToBeacon, WhoWasUnsureMayFindItselfElsewhere) {
  Beacon unsure = Ahead(0, 3);
  unsure.covariance = {.xx_m2 = 0.16, .yy_m2 = 0.16};
  HearFor(5, ClearScan(0), unsure);
  Hear(ClearScan(0), Ahead(0, 4));
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(FromBeaconToBeacon, AfterASilenceThereIsNothingToCompareWith) {
  HearFor(5, ClearScan(0), Ahead(0, 3));
  for (int i = 0; i < 5; ++i) bench_.Step(ClearScan(0));
  Hear(ClearScan(0), Ahead(0, 4));
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(FromBeaconToBeacon, DrivingAtFullSpeedIsNoJumpHoweverManyAreLost) {
  for (int i = 0; i < 60; i += 3) {
    Beacon beacon = Ahead(0, 2 + 0.05 * i);
    beacon.wheels = {1 / 0.0975, 1 / 0.0975};
    beacon.world_from_body.heading_rad = 0;
    Hear(ClearScan(0), beacon);
    bench_.Step(ClearScan(0));
    bench_.Step(ClearScan(0));
  }
  EXPECT_EQ(Counted().Total(), 0U);
}

TEST_F(FromBeaconToBeacon, SpeedingUpFasterThanItSaysItCanIsImpossible) {
  HearFor(5, ClearScan(0), Ahead(0, 3));
  Beacon beacon = Ahead(0, 3);
  beacon.wheels = {0.5 / 0.0975, 0.5 / 0.0975};
  Hear(ClearScan(0), beacon);
  EXPECT_EQ(Counted().impossible_speeds, 1U);
  EXPECT_EQ(Counted().Total(), 1U);
  EXPECT_TRUE(Doubted());
}

TEST_F(FromBeaconToBeacon, FasterThanAnybodyOfTheFleetIsImpossibleInEachBeacon) {
  Beacon beacon = Ahead(0, 3);
  beacon.drive.wheel_radius_m = 0.5;
  beacon.wheels = {-6, -6};
  HearFor(5, ClearScan(0), beacon);
  EXPECT_EQ(Counted().impossible_speeds, 3U);  // the first of four has none before it
}

TEST_F(FromBeaconToBeacon, AnEchoIsNotTakenForTheBodyOfADoubtedPeer) {
  HearFor(5, HearingAhead(0.65), Ahead(0, 0.65));
  EXPECT_NE(out_.command.decision.rule, Rule::kObstacle);
  Hear(HearingAhead(0.65), Ahead(0, 2));
  Hear(HearingAhead(0.65), Ahead(0, 0.65));
  EXPECT_EQ(out_.command.decision.rule, Rule::kObstacle);
}

}  // namespace
}  // namespace giveway
