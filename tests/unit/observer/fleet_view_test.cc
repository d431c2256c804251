#include "services/observer/fleet/fleet_view.h"

#include <gtest/gtest.h>

#include "services/observer/fleet/fleet_json.h"

namespace giveway {
namespace {

using std::chrono::seconds;

constexpr VehicleId kSeven{7};
constexpr WorldEpoch kFirst{1};
constexpr WorldEpoch kSecond{2};

VehicleStatus StatusWith(std::uint32_t count) {
  VehicleStatus status;
  status.vehicle = kSeven;
  FigureSummary& age = status.timing.figures[static_cast<std::size_t>(DriveFigure::kBeaconAge)];
  age.count = count;
  for (std::uint32_t n = 0; n < FigureSummary::kNewest; ++n) age.newest[n] = 50'000;
  return status;
}

Truth TruthOf(WorldEpoch epoch) {
  Truth truth;
  truth.vehicle = kSeven;
  truth.epoch = epoch;
  return truth;
}

TEST(FleetView, ABodyThatTheWorldHasTakenOutIsNone) {
  FleetView view;
  Truth truth = TruthOf(kFirst);
  truth.present = true;
  ReceivedBeacon received{.crc_valid = true, .name_valid = true, .writer = 1};
  received.beacon.vehicle = kSeven;
  view.Fold({.truths = {truth}, .statuses = {StatusWith(0)}, .beacons = {received}}, seconds(1));
  ASSERT_NE(view.Find(kSeven)->Body(), nullptr);
  ASSERT_NE(FleetJson(view, seconds(1)).find("world_from_body"), std::string::npos);
  truth.present = false;
  view.Fold({.truths = {truth}}, seconds(2));
  EXPECT_EQ(view.Find(kSeven)->Body(), nullptr);
  EXPECT_EQ(FleetJson(view, seconds(2)).find("world_from_body"), std::string::npos);
}

TEST(FigureHistogram, CountsEachValueOfAReportOnce) {
  FigureHistogram histogram;
  FigureSummary summary;
  summary.count = 3;
  summary.newest = {10'000, 10'001, 2'000'000};
  histogram.Fold(summary);
  histogram.Fold(summary);
  EXPECT_EQ(histogram.Values(), 3U);
  EXPECT_EQ(histogram.Count(0), 1U) << "a value on the limit belongs below it";
  EXPECT_EQ(histogram.Count(1), 1U);
  EXPECT_EQ(histogram.Above(), 1U);
  EXPECT_DOUBLE_EQ(histogram.Sum_us(), 2'020'001);
  EXPECT_EQ(histogram.Newest_us(), 2'000'000U);
}

TEST(FigureHistogram, OfReportsMissedItCountsWhatTheNextCarries) {
  FigureHistogram histogram;
  FigureSummary summary;
  summary.count = 100;
  histogram.Fold(summary);
  EXPECT_EQ(histogram.Values(), 16U);
}

TEST(FigureHistogram, GoesOnWithAProcessThatStartedAgain) {
  FigureHistogram histogram;
  FigureSummary summary;
  summary.count = 5;
  histogram.Fold(summary);
  summary.count = 2;
  histogram.Fold(summary);
  EXPECT_EQ(histogram.Values(), 7U);
}

TEST(FleetView, TakesTheFiguresOfAStatus) {
  FleetView view;
  view.Fold({.statuses = {StatusWith(4)}}, seconds(1));
  EXPECT_EQ(view.Find(kSeven)->beacon_age.Values(), 4U);
}

TEST(FleetView, ANewWorldTakesBodiesAndSignalsOfTheOldAway) {
  FleetView view;
  SignalState signal;
  signal.id = SignalId{1};
  view.Fold({.truths = {TruthOf(kFirst)}, .statuses = {StatusWith(1)}}, seconds(1));
  view.Fold({.signals = {signal}}, seconds(1));
  ASSERT_TRUE(view.Find(kSeven)->truth);
  Truth other = TruthOf(kSecond);
  other.vehicle = VehicleId{8};
  view.Fold({.truths = {other}}, seconds(2));
  EXPECT_FALSE(view.Find(kSeven)->truth);
  EXPECT_TRUE(view.Signals().empty());
}

TEST(FleetView, KeepsABoundedNumberOfEvents) {
  FleetView view;
  for (std::uint32_t n = 1; n <= 2000; ++n) {
    WorldEvent event;
    event.seq = n;
    view.Fold({.events = {event}}, seconds(1));
  }
  EXPECT_EQ(view.Events().size(), FleetView::kMostEvents);
  EXPECT_EQ(view.Events().back().seq, 2000U);
}

TEST(FleetView, RangesOfAnotherWorldStayOut) {
  FleetView view;
  view.Fold({.truths = {TruthOf(kFirst)}}, seconds(1));
  RangeScan scan;
  scan.vehicle = kSeven;
  scan.epoch = kSecond;
  view.Fold({.ranges = {scan}}, seconds(1));
  EXPECT_FALSE(view.Find(kSeven)->ranges);
  scan.epoch = kFirst;
  view.Fold({.ranges = {scan}}, seconds(1));
  EXPECT_TRUE(view.Find(kSeven)->ranges);
}

}  // namespace
}  // namespace giveway
