#include "services/fleetctl/output/live_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace giveway::fleetctl {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

VehicleStatus GivingWay() {
  VehicleStatus status;
  status.vehicle = VehicleId{2};
  status.decision = {Mode::kCooperative, Rule::kGiveWay, VehicleId{1}, 3, Tick{40}};
  status.forward_m_s = 0.125;
  status.nearest_echo_m = 0.934;
  status.peers_heard = 1;
  status.qos.deadline_missed = 4;
  status.qos.liveliness_lost = 1;
  return status;
}

TableView ViewOf(std::uint32_t vehicles) {
  TableView view{"intersection_yield", 7, "running", 12.34, 60, {}, {}, {}};
  for (std::uint32_t id = 1; id <= vehicles; ++id) view.vehicles.push_back(VehicleId{id});
  view.statuses[VehicleId{2}] = GivingWay();
  return view;
}

TEST(LiveTable, RowNamesModeReasonPeerSpeedEchoAndEvents) {
  const std::vector<std::string> lines = TableLines(ViewOf(2), {120, 24});
  ASSERT_THAT(lines, SizeIs(4));
  for (const char* part : {"2", "cooperative", "give_way 1", "0.12", "0.93", "4 missed, 1 lost"}) {
    EXPECT_THAT(lines[3], HasSubstr(part));
  }
}

TEST(LiveTable, TitleNamesScenarioDomainStateAndTime) {
  const std::string title = TableLines(ViewOf(2), {120, 24})[0];
  EXPECT_EQ(title, "intersection_yield  domain 7  running  12.3 s of at most 60 s");
}

TEST(LiveTable, TitleOfARunWithoutAnEndSaysSo) {
  TableView view = ViewOf(2);
  view.duration_s = 0;
  EXPECT_EQ(TableLines(view, {120, 24})[0],
            "intersection_yield  domain 7  running  12.3 s until stopped");
}

// A killed vehicle stood in the table as cruising at its last speed until the end of the run.
TEST(LiveTable, ASilentVehicleShowsNoStateItNoLongerHas) {
  TableView view = ViewOf(2);
  view.silent = {VehicleId{2}};
  const std::string row = TableLines(view, {120, 24})[3];
  EXPECT_THAT(row, HasSubstr("silent"));
  EXPECT_THAT(row, Not(HasSubstr("give_way")));
  EXPECT_THAT(row, Not(HasSubstr("0.12")));
  EXPECT_THAT(ProgressLine(view), Not(HasSubstr("give_way")));
}

TEST(LiveTable, VehicleNeverHeardOfHasARowAllTheSame) {
  EXPECT_THAT(TableLines(ViewOf(2), {120, 24})[2], HasSubstr("not heard yet"));
}

TEST(LiveTable, RefusedBeaconsAndIncompatibleQosShowOnlyWhenThereAreAny) {
  TableView view = ViewOf(2);
  EXPECT_THAT(TableLines(view, {120, 24})[3], Not(HasSubstr("refused")));
  view.statuses[VehicleId{2}].beacons.rejected_crc = 3;
  view.statuses[VehicleId{2}].qos.incompatible_qos = 1;
  EXPECT_THAT(TableLines(view, {120, 24})[3], HasSubstr("1 incompatible, 3 refused"));
}

TEST(LiveTable, WhatDoesNotFitShowsOnlyWhereThereIsAny) {
  TableView view = ViewOf(2);
  EXPECT_THAT(TableLines(view, {120, 24})[3], Not(HasSubstr("do not fit")));
  view.statuses[VehicleId{2}].trust = {1, 1, 0, 2, 0};
  EXPECT_THAT(TableLines(view, {120, 24})[3], HasSubstr(", 4 do not fit"));
}

TEST(LiveTable, NoLineIsWiderThanTheTerminal) {
  for (int columns = 0; columns <= 100; ++columns) {
    const std::vector<std::string> lines = TableLines(ViewOf(3), {columns, 24});
    EXPECT_THAT(lines, Each(SizeIs(testing::Le(static_cast<std::size_t>(columns)))));
  }
}

TEST(LiveTable, NeverTallerThanTheTerminalLessOneRow) {
  for (int rows = 0; rows <= 60; ++rows) {
    const std::size_t most = static_cast<std::size_t>(std::max(rows - 1, 0));
    EXPECT_LE(TableLines(ViewOf(40), {80, rows}).size(), most) << rows;
  }
}

TEST(LiveTable, VehiclesThatDoNotFitAreCounted) {
  const std::vector<std::string> lines = TableLines(ViewOf(40), {80, 10});
  ASSERT_THAT(lines, SizeIs(9));  // title, header, six vehicles, the rest
  EXPECT_THAT(lines.back(), HasSubstr("and 34 more"));
}

TEST(LiveTable, VehiclesThatJustFitAreAllShown) {
  const std::vector<std::string> lines = TableLines(ViewOf(7), {80, 10});
  ASSERT_THAT(lines, SizeIs(9));
  EXPECT_THAT(lines.back(), testing::StartsWith("      7"));
}

TEST(LiveTable, AbsurdNumbersBreakNothing) {
  TableView view = ViewOf(2);
  VehicleStatus& status = view.statuses[VehicleId{2}];
  status.forward_m_s = std::numeric_limits<double>::quiet_NaN();
  status.nearest_echo_m = -std::numeric_limits<double>::infinity();
  status.qos.deadline_missed = std::numeric_limits<std::uint32_t>::max();
  EXPECT_THAT(TableLines(view, {80, 24}), Each(SizeIs(testing::Le(80U))));
}

TEST(ProgressLine, NamesWhoGivesWayToWhom) {
  EXPECT_EQ(ProgressLine(ViewOf(2)),
            "intersection_yield  domain 7  running  12.3 s of at most 60 s: 1 of 2 vehicles, "
            "2 give_way 1");
}

}  // namespace
}  // namespace giveway::fleetctl
