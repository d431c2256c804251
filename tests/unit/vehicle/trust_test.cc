// Each kind of contradiction between a peer's beacons and the own sensors, and what only looks like
// one.
#include "services/vehicle/estimation/trust.h"

#include <gtest/gtest.h>

#include "tests/support/trust_bench.h"

namespace giveway {
namespace {

using test::Ahead;
using test::BeaconOf;
using test::ClearScan;
using test::HearingAhead;
using test::Trust;

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

// Which had every peer doubted in every tick, and two vehicles halted for each other for ever.
TEST_F(SaysItStands, AndStandsInTicksLongerThanItMayCloseIn) {
  VehicleOptions options = test::DefaultOptions();
  options.tick_period = std::chrono::milliseconds(410);
  options.beacon_age_limit = std::chrono::seconds(2);
  options.ranges_age_limit = 3 * options.tick_period;
  Begin(options);
  HearFor(20, HearingAhead(2.5), Ahead(0, 2.5));
  EXPECT_EQ(Counted().Total(), 0U);
  EXPECT_FALSE(Doubted());
  ComeNearer(0.1, 10, true);
  EXPECT_EQ(Counted().halted_but_closing, 1U);
  EXPECT_TRUE(Doubted());
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

// A vehicle that drove between the two, whose beacon was too far off to explain its echo, had an
// honest peer doubted: the other cone still heard that one stand.
TEST_F(SaysItStands, AndOneConeOfTwoStillHearsItStand) {
  Beacon unsure = Ahead(0, 2.5);
  unsure.covariance = {.xx_m2 = 0.02, .yy_m2 = 0.02};
  HearFor(30, HearingAhead(2.5), unsure);
  for (int i = 1; i <= 16; ++i) {
    RangeScan scan = HearingAhead(2.5);
    test::SetEcho(&scan, 3, HearingAhead(2.5 - 0.015 * i).readings[3].range_m);
    Hear(scan, unsure);
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
