#include "services/fleetctl/observe/listen_topics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

// One sample a topic and vehicle, of vehicles 1 and 2.
link::Observed OneOfEach() {
  link::Observed observed;
  for (const VehicleId vehicle : {VehicleId{1}, VehicleId{2}}) {
    ReceivedBeacon received{.crc_valid = true, .name_valid = true, .writer = 1};
    received.beacon.vehicle = vehicle;
    received.beacon.seq = 41;
    received.beacon.wheels = {2.05, -1.5};
    received.beacon.gives_way_to = VehicleId{3};
    observed.beacons.push_back(received);
    VehicleStatus status;
    status.vehicle = vehicle;
    status.beacons.lost = 5;
    observed.statuses.push_back(status);
    observed.truths.push_back({.vehicle = vehicle, .time_s = 1.25});
    RosterEntry entry;
    entry.vehicle = vehicle;
    observed.roster.push_back(entry);
  }
  observed.events.push_back({.kind = EventKind::kHalted,
                             .time_s = 4.5,
                             .vehicle = VehicleId{2},
                             .other = VehicleId{1},
                             .text = "give_way"});
  observed.signals.push_back({.id = SignalId{4}, .phase = SignalPhase::kRed, .to_change_s = 3});
  observed.figures = RunFigures{.passed = true, .reason = "expectations_met", .state_hash = 255};
  return observed;
}

constexpr ListenTopic kAll[] = {ListenTopic::kBeacon, ListenTopic::kStatus, ListenTopic::kRoster,
                                ListenTopic::kSignal, ListenTopic::kTruth,  ListenTopic::kEvent,
                                ListenTopic::kFigures};

TEST(ListenTopics, EveryTopicIsFoundByItsName) {
  for (const ListenTopic topic : kAll) {
    EXPECT_EQ(ListenTopicNamed(Name(topic)), topic);
    EXPECT_THAT(ListenTopicNames(), HasSubstr(std::string(Name(topic))));
  }
}

TEST(ListenTopics, WhatIsNoTopicIsNotFound) {
  for (const char* name : {"", "fleet", "fleet/beacons", "FLEET/BEACON", "beacon"}) {
    EXPECT_FALSE(ListenTopicNamed(name).has_value()) << name;
  }
}

TEST(ListenTopics, EachTopicGivesItsOwnSamplesALineEach) {
  const std::size_t counts[] = {2, 2, 2, 1, 2, 1, 1};
  for (std::size_t i = 0; i < std::size(kAll); ++i) {
    for (const bool json : {false, true}) {
      const auto lines = SampleLines(OneOfEach(), {kAll[i], {}, json}, 0.5);
      EXPECT_THAT(lines, SizeIs(counts[i])) << Name(kAll[i]);
      EXPECT_THAT(lines, testing::Each(Not(HasSubstr("\n"))));
    }
  }
}

TEST(ListenTopics, ABeaconsLineIsHeadedByTimeAndVehicleAndTellsItsWheels) {
  const auto lines = SampleLines(OneOfEach(), {ListenTopic::kBeacon, {VehicleId{2}}, false}, 1.5);
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_THAT(lines[0], StartsWith("    1.500  vehicle 2  #41"));
  EXPECT_THAT(lines[0], AllOf(HasSubstr("wheels 2.05 -1.50 rad/s"), HasSubstr("gives way to 3"),
                              Not(HasSubstr("WRONG"))));
}

TEST(ListenTopics, ABrokenBeaconIsShownAsBroken) {
  link::Observed observed = OneOfEach();
  observed.beacons.resize(1);
  observed.beacons[0].crc_valid = false;
  EXPECT_THAT(SampleLines(observed, {}, 0), ElementsAre(HasSubstr("CHECK SUM WRONG")));
  observed.beacons[0] = {.beacon = observed.beacons[0].beacon, .crc_valid = true};
  EXPECT_THAT(SampleLines(observed, {}, 0), ElementsAre(HasSubstr("NOT ITS WRITER'S ID")));
}

TEST(ListenTopics, JsonNamesTopicAndFields) {
  const auto lines = SampleLines(OneOfEach(), {ListenTopic::kBeacon, {VehicleId{1}}, true}, 1.5);
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_THAT(lines[0], StartsWith(R"({"topic":"fleet/beacon","heard_s":1.5,"vehicle":1,)"));
  EXPECT_THAT(lines[0], AllOf(HasSubstr(R"("left_rad_s":2.05,"right_rad_s":-1.5)"),
                              HasSubstr(R"("gives_way_to":3)"), Not(HasSubstr("blocked_by"))));
}

TEST(ListenTopics, AHeapThatAVehicleDoesNotSayIsLeftOut) {
  link::Observed observed;
  observed.statuses = {{.vehicle = VehicleId{1}}, {.vehicle = VehicleId{2}, .heap_bytes = 7}};
  EXPECT_THAT(SampleLines(observed, {ListenTopic::kStatus, {}, true}, 0),
              ElementsAre(Not(HasSubstr("heap_bytes")), HasSubstr(R"("heap_bytes":7)")));
}

TEST(ListenTopics, AnEventIsChosenByEitherOfItsTwo) {
  for (const std::uint32_t id : {1U, 2U}) {
    EXPECT_THAT(SampleLines(OneOfEach(), {ListenTopic::kEvent, {VehicleId{id}}, false}, 0),
                ElementsAre(HasSubstr("4.50 s  halted  other 1")));
  }
  EXPECT_THAT(SampleLines(OneOfEach(), {ListenTopic::kEvent, {VehicleId{3}}, false}, 0), IsEmpty());
}

TEST(ListenTopics, TextFromTheNetworkCannotReachTheTerminalRaw) {
  link::Observed observed;
  observed.events.push_back({.text = "\x1b[31m\nred"});
  for (const bool json : {false, true}) {
    const auto lines = SampleLines(observed, {ListenTopic::kEvent, {}, json}, 0);
    ASSERT_THAT(lines, SizeIs(1));
    EXPECT_THAT(lines[0], AllOf(Not(HasSubstr("\x1b")), HasSubstr("\\u001b[31m\\nred")));
  }
}

TEST(ListenTopics, AHashIsHexadecimalBecauseJsonNumbersAreNotThatWide) {
  EXPECT_THAT(SampleLines(OneOfEach(), {ListenTopic::kFigures, {}, true}, 0),
              ElementsAre(HasSubstr(R"("state_hash":"00000000000000ff")")));
}

TEST(ListenTopics, OnlySignalsAndFiguresAreNotAboutVehicles) {
  for (const ListenTopic topic : kAll) {
    EXPECT_EQ(IsAboutVehicles(topic),
              topic != ListenTopic::kSignal && topic != ListenTopic::kFigures);
  }
}

}  // namespace
}  // namespace giveway::fleetctl
