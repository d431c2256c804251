#include "services/fleetctl/qos/canary.h"

#include <gmock/gmock.h>

namespace giveway::fleetctl {
namespace {

using ::testing::HasSubstr;

ServiceFigures Figures(std::uint64_t alarms, std::uint64_t lost, std::uint64_t taken,
                       double pair_seconds) {
  return {.alarms = alarms,
          .lost = lost,
          .taken = taken,
          .seconds = pair_seconds / 3,
          .pair_seconds = pair_seconds};
}

TEST(Canary, CountsFromOneReportToALater) {
  VehicleStatus before;
  before.peers_heard = 2;
  before.qos.deadline_missed = 3;
  before.beacons.taken = 100;
  VehicleStatus after = before;
  after.qos.deadline_missed = 5;
  after.qos.liveliness_lost = 1;
  after.beacons.taken = 160;
  after.beacons.lost = 4;
  const ServiceFigures figures = Between(before, after, 10);
  EXPECT_EQ(figures.alarms, 3U);
  EXPECT_EQ(figures.lost, 4U);
  EXPECT_EQ(figures.taken, 60U);
  EXPECT_EQ(figures.seconds, 10);
  EXPECT_EQ(figures.pair_seconds, 20);
  EXPECT_EQ(figures.AlarmsPerPairHour(), 540);
  EXPECT_EQ(figures.LostShare(), 4.0 / 64);
}

TEST(Canary, ThatServesLikeTheRestIsNoWorse) {
  EXPECT_EQ(WhyWorse(Figures(0, 0, 600, 30), Figures(0, 0, 4200, 210)), "");
  EXPECT_EQ(WhyWorse(Figures(3, 60, 540, 30), Figures(20, 420, 3780, 210)), "");
}

TEST(Canary, IsNotJudgedByOneAlarmThatChanceMayBring) {
  EXPECT_EQ(WhyWorse(Figures(1, 0, 600, 30), Figures(0, 0, 4200, 210)), "");
}

TEST(Canary, ThatRaisesMoreAlarmsIsWorse) {
  EXPECT_THAT(WhyWorse(Figures(30, 0, 600, 30), Figures(20, 0, 4200, 210)), HasSubstr("alarms"));
}

TEST(Canary, ThatLosesMoreBeaconsIsWorse) {
  EXPECT_THAT(WhyWorse(Figures(0, 120, 480, 30), Figures(0, 420, 3780, 210)), HasSubstr("lost"));
}

TEST(Canary, ThatHearsNobodyIsWorse) {
  EXPECT_THAT(WhyWorse(Figures(0, 0, 0, 0), Figures(0, 0, 4200, 210)), HasSubstr("no beacon"));
}

TEST(Canary, ThatHearsOnlySomeOfThePeersIsWorse) {
  EXPECT_THAT(WhyWorse(Figures(0, 0, 400, 30), Figures(0, 0, 4200, 210)), HasSubstr("takes 40"));
}

TEST(Canary, WithoutAnyRestToCompareItWithIsNotPromoted) {
  EXPECT_THAT(WhyWorse(Figures(0, 0, 600, 30), {}), HasSubstr("no other vehicle"));
}

// The last reports of the process before the restart ended the wait, and the trial started while
// the canary still looked for its peers.
TEST(Canary, HearsAgainOnlyByWhatItsNewProcessSays) {
  const VehicleId canary{3};
  const auto status = [&](std::uint32_t sent, std::uint32_t taken) {
    VehicleStatus one;
    one.vehicle = canary;
    one.beacons.sent = sent;
    one.beacons.taken = taken;
    return one;
  };
  SeenVehicles seen;
  EXPECT_FALSE(seen.Hears(canary, false));
  seen.Add(status(1000, 500), SteadyTime(1));
  EXPECT_TRUE(seen.Hears(canary, false));
  seen.Add(status(1004, 504), SteadyTime(2));
  EXPECT_FALSE(seen.Hears(canary, true));
  seen.Add(status(2, 0), SteadyTime(3));
  EXPECT_FALSE(seen.Hears(canary, true));
  seen.Add(status(6, 1), SteadyTime(4));
  EXPECT_TRUE(seen.Hears(canary, true));
}

}  // namespace
}  // namespace giveway::fleetctl
