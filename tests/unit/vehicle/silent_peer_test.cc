// Neither beacon nor echo: ultrasonics that fail near a peer that has fallen silent.
#include <gtest/gtest.h>

#include "services/vehicle/situation/sonar_trust.h"
#include "tests/support/trust_bench.h"

namespace giveway {
namespace {

using test::Ahead;
using test::BeaconOf;
using test::ClearScan;
using test::HearingAhead;
using test::Trust;

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
  // All of these, and no echo.
  void HearAll(int ticks, std::vector<Beacon> beacons) {
    for (int i = 0; i < ticks; ++i) {
      for (Beacon& beacon : beacons) {
        beacon.tick = Tick{bench_.NextTick() - 1};
        beacon.seq = bench_.NextTick() - 1;
      }
      out_ = bench_.Step(ClearScan(0), beacons);
    }
  }
  void BeginWithRadioReach(double radius_m) {
    VehicleOptions options = test::DefaultOptions();
    options.emission_radius_m = radius_m;
    Begin(options);
  }
  void BeginWithBodiesThatStay(Nanoseconds time) {
    VehicleOptions options = test::DefaultOptions();
    options.silent_body_stays = time;
    Begin(options);
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
  StepOn(Everywhere(4.95), 1);  // from where an echo may vanish
  StepOn(ClearScan(0), 4);
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

TEST_F(SilentPeer, IsNotNearWhereAnEchoVanishes) {
  BeginWithRadioReach(20);
  HearFor(10, HearingAhead(1), Ahead(0, -8));
  StepOn(HearingAhead(1), 10);
  StepOn(ClearScan(0), 20);
  EXPECT_FALSE(Halts());
}

// Off for three seconds by the time it falls silent, near and in no cone.
TEST_F(SilentPeer, IsNotDrivenPastWhereAnEchoVanishedWhileItSpoke) {
  HearFor(10, HearingAhead(1), Ahead(0, -1));
  HearFor(60, ClearScan(0), Ahead(0, -1));
  EXPECT_FALSE(Halts());
  StepOn(ClearScan(0), 10);
  EXPECT_TRUE(Halts());
  StepOn(ClearScan(0), 100);
  EXPECT_TRUE(Halts()) << "it may be anywhere near";
}

// Another that speaks is squarely in a cone, and not heard.
TEST_F(SilentPeer, IsNotDrivenPastWhereAnotherIsNotHeard) {
  const std::vector<Beacon> both{Ahead(0, -1),
                                 BeaconOf(3, 0, {.position_world = {0, 1.5}, .heading_rad = 0})};
  HearAll(10, both);
  EXPECT_FALSE(Halts());
  StepOn(ClearScan(0), 10);
  EXPECT_TRUE(Halts());
}

TEST_F(SilentPeer, IsDrivenPastWhereAnotherWasNotHeardForAMoment) {
  const std::vector<Beacon> both{Ahead(0, -1),
                                 BeaconOf(3, 0, {.position_world = {0, 1.5}, .heading_rad = 0})};
  HearAll(1, both);
  HearFor(1, ClearScan(0), Ahead(0, -1));
  StepOn(ClearScan(0), 20);
  EXPECT_FALSE(Halts());
}

TEST_F(SilentPeer, IsDrivenPastWhereUltrasonicsWereOffOnce) {
  HearFor(10, HearingAhead(1), Ahead(0, -1));
  HearFor(20, ClearScan(0), Ahead(0, -1));
  HearFor(5, HearingAhead(1), Ahead(0, -1));
  EXPECT_EQ(bench_.Brain().State().sensed.doubt.shown_by, ScanNews::kNone)
      << "nothing is left of it";
  HearFor(15, HearingAhead(1), Ahead(0, -1));
  StepOn(HearingAhead(1), 20);
  EXPECT_FALSE(Halts());
}

// Silent for five seconds when it shows. A leader that others do not hear drives on all the same.
TEST_F(SilentPeer, IsNotDrivenPastWhereUltrasonicsFailLate) {
  FallSilent(2, 100);
  Leap(10);
  EXPECT_TRUE(Halts());
}

// By its speed it might be near by then.
TEST_F(SilentPeer, WhoWasFarOffDoesNotComeNearByBeingSilent) {
  BeginWithRadioReach(20);
  HearFor(10, HearingAhead(1), Ahead(0, -8));
  HearFor(5, ClearScan(0), Ahead(0, -8));
  StepOn(ClearScan(0), 200);
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

TEST_F(SilentPeer, IsNotWhereOneThatWasTakenAwayVanishes) {
  Beacon other = BeaconOf(3, 0, {.position_world = {2, 0}});
  HearFor(5, HearingAhead(2), other);
  StepOn(HearingAhead(2), 80);
  HearFor(10, HearingAhead(2), Ahead(0, -2));
  StepOn(HearingAhead(2), 10);
  StepOn(ClearScan(0), 20);
  EXPECT_FALSE(Halts());
}

// Where a world takes silent bodies away at once, each survivor halted until it forgot the peer.
TEST_F(SilentPeer, IsNotWhereOneVanishesThatAWorldTakesAwayAtOnce) {
  for (const int seconds : {1, 2, 3}) {
    BeginWithBodiesThatStay(std::chrono::seconds(seconds));
    FallSilent(2, 20 * seconds - 2);
    StepOn(ClearScan(0), 100);
    EXPECT_FALSE(Halts()) << seconds;
  }
}

TEST_F(SilentPeer, IsWhereOneVanishesThatAWorldLeavesThere) {
  BeginWithBodiesThatStay(std::chrono::seconds(20));
  FallSilent(2, 100);
  StepOn(ClearScan(0), 10);
  EXPECT_TRUE(Halts()) << "nothing has taken it away yet";
  BeginWithBodiesThatStay(std::chrono::seconds(20));
  FallSilent(2, 400);
  StepOn(ClearScan(0), 10);
  EXPECT_FALSE(Halts());
}

// What is there after twice as long was not taken away.
TEST_F(SilentPeer, IsWhereAnotherVanishesThatHasBeenSilentForLong) {
  HearFor(5, HearingAhead(2), BeaconOf(3, 0, {.position_world = {2, 0}}));
  StepOn(HearingAhead(2), 170);
  HearFor(10, HearingAhead(2), Ahead(0, -2));
  StepOn(HearingAhead(2), 10);
  StepOn(ClearScan(0), 20);
  EXPECT_TRUE(Halts());
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

TEST_F(SilentPeer, WhoSpokeInBetweenIsUnheardAgainAsLongAsScansAreTheSame) {
  FallSilent(2);
  DriveOn(HearingAhead(2), 20);
  ASSERT_TRUE(Halts());
  HearFor(10, HearingAhead(2), Ahead(0, 2));
  EXPECT_FALSE(Halts());
  StepOn(HearingAhead(2), 20);
  EXPECT_TRUE(Halts());
}

TEST_F(SilentPeer, IsNotNearWhereEchoesStayTheSame) {
  BeginWithRadioReach(20);
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

}  // namespace
}  // namespace giveway
