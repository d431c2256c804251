// What a candidate should show, calculated: compared with sums by hand and with a simulation.
#include "services/fleetctl/tune/tune_predict.h"

#include <gtest/gtest.h>

#include "services/types/math/random.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;

constexpr TuneFleet kFleet{.vehicles = 4, .tick_ms = 50, .age_limit_ms = 200};
constexpr double kPairsTimesBeaconsAnHour = 3 * 72000;

BeaconQos Qos(int requested_ms, int lease_ms = 250) {
  return {.offered = milliseconds(100),
          .requested = milliseconds(requested_ms),
          .lease = milliseconds(lease_ms),
          .reliable = false,
          .depth = 4};
}

double Alarms(const BeaconQos& qos, const BeaconChannel& channel) {
  return Predict(qos, channel, kFleet)->alarms_per_hour / kPairsTimesBeaconsAnHour;
}

TEST(TunePredict, SilencesOfIndependentLossesAreAGeometricSeries) {
  const BeaconChannel channel{.loss = 0.1};
  EXPECT_NEAR(SilenceProbability(channel, 0), 0.9, 1e-12);
  EXPECT_NEAR(SilenceProbability(channel, 3), 0.9 * 0.001, 1e-12);
}

TEST(TunePredict, SilencesInBurstsAreThoseOfASimulatedChannel) {
  const BeaconChannel channel{.loss = 0.05, .burst = 0.2, .burst_length = 4, .burst_loss = 0.8};
  Random random(1);
  const double to_bad = 0.2 / (0.8 * 4);
  bool bad = false;
  int run = -1;  // lost since the last that arrived; -1 before the first
  std::array<int, 5> begun{};
  constexpr int kPackets = 1'000'000;
  for (int i = 0; i < kPackets; ++i) {
    const double turn = random.Uniform(0, 1);
    bad = bad ? turn >= 0.25 : turn < to_bad;
    const bool lost = random.Uniform(0, 1) < 0.05 || (bad && random.Uniform(0, 1) < 0.8);
    run = lost ? (run < 0 ? run : run + 1) : 0;
    if (run >= 0 && run < 5) ++begun[static_cast<std::size_t>(run)];
  }
  for (int lost = 0; lost < 5; ++lost) {
    EXPECT_NEAR(begun[static_cast<std::size_t>(lost)] / double{kPackets},
                SilenceProbability(channel, lost), 0.003)
        << lost;
  }
}

TEST(TunePredict, NothingLostIsNoAlarm) { EXPECT_EQ(Alarms(Qos(150), {}), 0); }

// No scans lost: any limit up to 200 ms reports three missing beacons in a row.
TEST(TunePredict, ADeadlineBetweenThreeAndFourPeriodsTakesThreeLosses) {
  EXPECT_NEAR(Alarms(Qos(175), {.loss = 0.1}), 0.9 * 0.001, 1e-9);
}

TEST(TunePredict, ADeadlineOfWholePeriodsMostlyWinsAgainstTheBeaconThatEndsIt) {
  const double two = 0.9 * 0.9 * 0.01;  // exactly two lost
  EXPECT_NEAR(Alarms(Qos(150), {.loss = 0.1}), 0.875 * two + 0.9 * 0.001, 1e-9);
}

TEST(TunePredict, AShorterLeaseTellsWhatTheDeadlineWouldTellLater) {
  EXPECT_NEAR(Alarms(Qos(190, 130), {.loss = 0.1}), 0.9 * 0.01, 1e-9);
}

TEST(TunePredict, BehindLongLimitsTheAgeOfBeaconsTells) {
  const double four = 0.9 * 0.9 * 1e-4;
  EXPECT_NEAR(Alarms(Qos(900, 900), {.loss = 0.1}), 0.5 * four + 0.9 * 1e-5, 1e-9);
}

// Limits too long to fire: the age limit is reached after 1.5, 3, 4 and 5 ticks; on a whole tick it
// is a coin toss.
TEST(TunePredict, WhileOwnScansAreLostTheAgeOfBeaconsTells) {
  const double three = 0.5 * 1e-3 + 0.5 * 1e-4;
  EXPECT_NEAR(Alarms(Qos(900, 900), {.scan_loss = 0.1}), 0.9 * three, 1e-9);
  const double lossy =
      Alarms(Qos(900, 900), {.loss = 0.1, .scan_loss = 0.1}) - Alarms(Qos(900, 900), {.loss = 0.1});
  const double one_before = 0.1 * (0.5 * 1e-2 + 0.5 * 1e-3);
  EXPECT_NEAR(lossy, 0.81 * (three + one_before + 1e-2 * 1e-2 + 1e-3 * 0.1), 1e-9);
}

TEST(TunePredict, ScansLostInBurstsTellMoreThanAsManyLostSingly) {
  ImpairmentRule bursts;
  bursts.burst = 0.1;
  bursts.burst_length = 3;
  bursts.from = ImpairedSender::kWorld;
  const auto channel = ChannelOf({.rules = {bursts}});
  ASSERT_TRUE(channel);
  EXPECT_NEAR(channel->scan_loss, 0.1, 1e-12);
  EXPECT_GT(Alarms(Qos(900, 900), *channel), 5 * Alarms(Qos(900, 900), {.scan_loss = 0.1}));
}

TEST(TunePredict, LateBeaconsOfSendersWithoutScansMakeSilencesLonger) {
  const BeaconChannel on_time{.loss = 0.1};
  const BeaconChannel late{.loss = 0.1, .scan_loss = 0.1};
  const double by_age = Alarms(Qos(900, 900), late) - Alarms(Qos(900, 900), on_time);
  EXPECT_GT(Alarms(Qos(165), late) - by_age, 1.05 * Alarms(Qos(165), on_time));
}

TEST(TunePredict, ADeadlineIsActedOnAtTheNextTurn) {
  const auto detection = [](int requested_ms, const BeaconChannel& channel) {
    return Predict(Qos(requested_ms), channel, kFleet)->detection_ms;
  };
  EXPECT_DOUBLE_EQ(detection(130, {}), 150);
  EXPECT_DOUBLE_EQ(detection(150, {}), 175);  // at one turn or the next
  EXPECT_DOUBLE_EQ(detection(190, {}), 200);
  EXPECT_DOUBLE_EQ(detection(230, {}), 250);
  EXPECT_DOUBLE_EQ(detection(190, {.delay_ms = 20}), 250);
  // Beacons lost before the death start the silence earlier: by 0.1 / 0.9 of a tick.
  EXPECT_NEAR(detection(190, {.loss = 0.1}), 200 - 50.0 / 9, 1e-6);
}

TEST(TunePredict, TheAgeIsOneTickAndWhatIsLost) {
  EXPECT_NEAR(Predict(Qos(150), {.loss = 0.1}, kFleet)->age_mean_ms, 50 + 50.0 / 9, 1e-6);
  EXPECT_NEAR(Predict(Qos(150), {.delay_ms = 60}, kFleet)->age_mean_ms, 100, 1e-6);
}

TEST(TunePredict, WhatHasNoClosedFormHasNoPrediction) {
  BeaconQos reliable = Qos(150);
  reliable.reliable = true;
  EXPECT_FALSE(Predict(reliable, {}, kFleet));
  ImpairmentRule limited;
  limited.rate_bytes_s = 1000;
  EXPECT_FALSE(ChannelOf({.rules = {limited}}));
  ImpairmentRule to_one;
  to_one.to_vehicle = VehicleId{2};
  EXPECT_FALSE(ChannelOf({.rules = {to_one}}));
}

TEST(TunePredict, OfSeveralRulesTheLastThatFitsCounts) {
  ImpairmentRule all;
  all.loss = 0.1;
  ImpairmentRule world;
  world.from = ImpairedSender::kWorld;
  const auto channel = ChannelOf({.rules = {all, world}});
  ASSERT_TRUE(channel);
  EXPECT_EQ(channel->loss, 0.1);
  EXPECT_EQ(channel->scan_loss, 0);
  EXPECT_DOUBLE_EQ(ChannelOf({.rules = {all}})->scan_loss, 0.1);
}

TEST(TunePredict, DisagreementIsNamedBeyondChanceAlone) {
  TuneFigures measured;
  measured.alarms_low = 80;
  measured.alarms_high = 120;
  measured.detections = 10;
  measured.detection_ms = 200;
  measured.detection_error_ms = 1;
  EXPECT_EQ(Disagreement(measured, {.alarms_per_hour = 100, .detection_ms = 195}), "");
  EXPECT_EQ(Disagreement(measured, {.alarms_per_hour = 79, .detection_ms = 200}),
            "more alarms than predicted");
  EXPECT_EQ(Disagreement(measured, {.alarms_per_hour = 121, .detection_ms = 180}),
            "fewer alarms than predicted, noticed later than predicted");
}

}  // namespace
}  // namespace giveway::fleetctl
