#include "services/fleetctl/observe/top_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Each;
using testing::HasSubstr;
using testing::Le;
using testing::Not;
using testing::SizeIs;

constexpr WorldEpoch kWorld{7};
constexpr TerminalSize kWide{200, 60};

ReceivedBeacon BeaconOf(std::uint32_t vehicle) {
  ReceivedBeacon received{.crc_valid = true, .name_valid = true, .writer = 1};
  received.beacon.vehicle = VehicleId{vehicle};
  received.beacon.mode = Mode::kCooperative;
  received.beacon.rule = Rule::kGiveWay;
  received.beacon.gives_way_to = VehicleId{1};
  received.beacon.wheels = {2, 2};
  return received;
}

VehicleStatus GivingWay(std::uint32_t vehicle) {
  VehicleStatus status;
  status.vehicle = VehicleId{vehicle};
  status.decision = {Mode::kCooperative, Rule::kGiveWay, VehicleId{1}, 3, Tick{40}};
  status.forward_m_s = 0.125;
  status.nearest_echo_m = 0.934;
  status.peers_heard = 6;
  status.qos.deadline_missed = 4;
  status.last_deadline_missed = VehicleId{9};
  status.trust.jumps = 3;
  status.packets.packets[static_cast<std::size_t>(PacketDrop::kNone)] = 900;
  status.packets.packets[static_cast<std::size_t>(PacketDrop::kMalformed)] = 5;
  status.last_event = QosEventKind::kUnmatched;
  status.last_event_about = VehicleId{8};
  return status;
}

ListeningPost Post() { return {7, "127.0.0.1", "main", seconds(0)}; }

// Vehicles 1 to `vehicles`, heard at 10 s.
FleetSnapshot FleetOf(std::uint32_t vehicles) {
  link::Observed observed;
  for (std::uint32_t id = 1; id <= vehicles; ++id) {
    observed.statuses.push_back(GivingWay(id));
    observed.beacons.push_back(BeaconOf(id));
  }
  observed.events.push_back({.kind = EventKind::kStarted, .epoch = kWorld, .time_s = 12.3});
  FleetSnapshot fleet;
  fleet.Fold(observed, seconds(10));
  return fleet;
}

TEST(TopTable, RowNamesModeReasonSpeedEchoBeaconAgeAndEventsWithWhomTheyWereAbout) {
  const auto lines = TopLines(FleetOf(2), Post(), milliseconds(10'040), kWide);
  ASSERT_THAT(lines, SizeIs(5));
  for (const char* part :
       {"2", "cooperative", "give_way 1", "0.12", "0.93", "40 ms",
        "4 missed (last 9), 3 do not fit, 5 packets dropped; last unmatched 8"}) {
    EXPECT_THAT(lines[4], HasSubstr(part));
  }
}

TEST(TopTable, TitleNamesTheWorldsStateAndWhereItListens) {
  const auto lines = TopLines(FleetOf(1), Post(), seconds(10), kWide);
  EXPECT_EQ(lines[0], "world running, 12.3 s  domain 7  127.0.0.1  area main");
  EXPECT_THAT(lines[1], HasSubstr("started"));
}

TEST(TopTable, AWorldThatFellSilentIsMarkedWithHowLong) {
  const auto lines = TopLines(FleetOf(1), Post(), seconds(15), kWide);
  EXPECT_THAT(lines[0], HasSubstr("world running, 12.3 s, silent for 5 s"));
}

TEST(TopTable, ASilentVehicleStaysMarkedWithHowLongAndShowsNoStateItNoLongerHas) {
  const auto row = TopLines(FleetOf(1), Post(), seconds(22), kWide)[3];
  EXPECT_THAT(row, HasSubstr("silent"));
  EXPECT_THAT(row, HasSubstr("for 12 s"));
  EXPECT_THAT(row, HasSubstr("4 missed (last 9)"));
  EXPECT_THAT(row, Not(HasSubstr("give_way")));
  EXPECT_THAT(row, Not(HasSubstr("0.12")));
}

TEST(TopTable, AForeignPeerIsShownByItsBeaconsAlone) {
  FleetSnapshot fleet;
  fleet.Fold({.beacons = {BeaconOf(5)}}, seconds(10));
  const auto row = TopLines(fleet, Post(), seconds(10), kWide)[3];
  for (const char* part : {"5", "give_way 1", "0.20", "no status heard"}) {
    EXPECT_THAT(row, HasSubstr(part));
  }
}

TEST(TopTable, ABodyThatSaysNothingHasARow) {
  FleetSnapshot fleet;
  fleet.Fold({.truths = {{.vehicle = VehicleId{3}, .epoch = kWorld}}}, seconds(10));
  EXPECT_THAT(TopLines(fleet, Post(), seconds(10), kWide)[3], HasSubstr("not heard"));
}

TEST(TopTable, NobodyHeardSaysWhatWasTriedAndWhatToCheck) {
  const std::string text = NothingHeard(Post(), seconds(5));
  for (const char* part : {"5.0 s", "domain 7", "127.0.0.1", "main", "--interface", "--qos"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(TopLines({}, Post(), seconds(5), {400, 24}).back(), HasSubstr(text));
}

TEST(TopTable, NoLineIsWiderThanTheTerminalAndNoTableTaller) {
  for (int size = 0; size <= 100; ++size) {
    const auto lines = TopLines(FleetOf(40), Post(), seconds(10), {size, size});
    EXPECT_THAT(lines, Each(SizeIs(Le(static_cast<std::size_t>(size)))));
    EXPECT_LE(lines.size(), static_cast<std::size_t>(std::max(size - 1, 0)));
  }
}

TEST(TopTable, VehiclesThatDoNotFitAreCounted) {
  const auto lines = TopLines(FleetOf(40), Post(), seconds(10), {80, 10});
  ASSERT_THAT(lines, SizeIs(9));  // two titles, header, five vehicles, the rest
  EXPECT_THAT(lines.back(), HasSubstr("and 35 more"));
}

TEST(TopJson, SaysWhoIsHeardAndWhatItsStatusCarries) {
  const std::string json = TopJson(FleetOf(1), Post(), milliseconds(10'500));
  for (const char* part :
       {R"({"domain":7,"interface":"127.0.0.1","area":"main","listening_s":10.5,)",
        R"("state":"running","silent":false,"heard_s_ago":0.5)",
        R"("vehicles":[{"id":1,"hearing":"heard","heard_s_ago":0.5,"beacon_age_s":0.5,)",
        R"("rule":"give_way","peer":1,"sensor":3)",
        R"("last_deadline_missed":9,"last_qos_event":{"kind":"unmatched","vehicle":8})",
        R"("jumps":3)"}) {
    EXPECT_THAT(json, HasSubstr(part));
  }
  EXPECT_THAT(json, Not(HasSubstr("last_liveliness_lost")));
}

TEST(TopJson, SaysWhatThePacketFilterDroppedAndWhatSamplesWereRefused) {
  link::Observed observed;
  observed.statuses.push_back(GivingWay(1));
  auto& packets = observed.statuses[0].packets.packets;
  for (std::size_t i = 0; i < packets.size(); ++i) packets[i] = 100 + i;
  observed.statuses[0].refused = {1, 2, 3, 4, 5, 6};
  auto fleet = FleetOf(1);
  fleet.Fold(observed, seconds(10));
  EXPECT_THAT(
      TopJson(fleet, Post(), seconds(10)),
      HasSubstr(
          R"("packets":{"handed_on":100,"dropped_foreign_source":101,"dropped_not_rtps":102,)"
          R"("dropped_unknown_kind":103,"dropped_statistics":104,"dropped_malformed":105,)"
          R"("dropped_list_too_long":106,"dropped_sample_too_large":107,)"
          R"("dropped_range_too_long":108,"dropped_sequence_jump":109,)"
          R"("dropped_too_many_strangers":110,"dropped_fragmented_announcement":111,)"
          R"("dropped_too_many_endpoints":112},"refused":{"unbound_samples":1,)"
          R"("unreadable_samples":2,"wrong_name_scans":3,"old_world_entries":4,"strangers":5,)"
          R"("implausible":6})"));
}

TEST(TopJson, NumbersThatJsonCannotSayAreLeftOut) {
  VehicleStatus status = GivingWay(1);
  status.forward_m_s = std::numeric_limits<double>::quiet_NaN();
  status.nearest_echo_m = std::numeric_limits<double>::infinity();
  FleetSnapshot fleet;
  fleet.Fold({.statuses = {status}}, seconds(10));
  const std::string json = TopJson(fleet, Post(), seconds(10));
  EXPECT_THAT(json, Not(HasSubstr("nan")));
  EXPECT_THAT(json, Not(HasSubstr("inf\"")));
  EXPECT_THAT(json, Not(HasSubstr("forward_m_s")));
}

// Its title was "no world heard".
TEST(TopTable, AWorldWithoutVehiclesIsHeardUntilItIsGone) {
  FleetSnapshot fleet;
  fleet.Fold({.world = 5}, seconds(1));
  EXPECT_THAT(TopLines(fleet, Post(), seconds(9), kWide)[0], HasSubstr("world without vehicles"));
  EXPECT_THAT(TopLines(fleet, Post(), seconds(9), kWide).back(),
              Not(HasSubstr("nothing received")));
  EXPECT_THAT(TopJson(fleet, Post(), seconds(9)), HasSubstr(R"("world":{"heard":true)"));
  fleet.Fold({}, seconds(10));
  EXPECT_THAT(TopLines(fleet, Post(), seconds(10), kWide)[0], HasSubstr("no world heard"));
  EXPECT_THAT(TopJson(fleet, Post(), seconds(10)), HasSubstr(R"("world":{"heard":false)"));
}

TEST(TopJson, AWorldThatFellSilentIsNoLongerHeard) {
  EXPECT_THAT(TopJson(FleetOf(1), Post(), seconds(15)),
              HasSubstr(R"("world":{"heard":false,"epoch":7,"state":"running","silent":true)"));
}

TEST(TopJson, NobodyIsAnEmptyListAndNoWorld) {
  EXPECT_THAT(TopJson({}, Post(), seconds(1)),
              HasSubstr(R"("world":{"heard":false},"vehicles":[])"));
}

}  // namespace
}  // namespace giveway::fleetctl
