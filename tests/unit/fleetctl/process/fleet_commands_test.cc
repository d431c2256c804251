#include "services/fleetctl/process/fleet_commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;
using testing::SizeIs;

Scenario TwoVehicles() {
  Scenario scenario;
  scenario.vehicles.resize(2);
  scenario.vehicles[0].id = VehicleId{3};
  scenario.vehicles[1].id = VehicleId{8};
  return scenario;
}

FleetSpec OnDomainFive() {
  FleetSpec spec;
  spec.program_folder = "/opt/bin";
  spec.scenario_file = "/tmp/s.textproto";
  spec.domain = 5;
  spec.qos_file = "/tmp/q.xml";
  spec.lock_fd = 9;
  return spec;
}

std::vector<ChildCommand> ChildrenOf(const FleetSpec& spec, const Scenario& scenario) {
  std::vector<ChildCommand> children;
  for (const MemberCommand& command : MakeCommands(spec, scenario)) {
    children.push_back(command.child);
  }
  return children;
}

// True if `flag` is followed by `value`.
bool Says(const ChildCommand& command, const std::string& flag, const std::string& value) {
  const auto found = std::ranges::find(command.words, flag);
  return found != command.words.end() && found + 1 != command.words.end() && found[1] == value;
}

TEST(MakeCommands, WorldComesFirstThenEveryVehicleByItsId) {
  const auto commands = ChildrenOf(OnDomainFive(), TwoVehicles());
  ASSERT_THAT(commands, SizeIs(3));
  EXPECT_EQ(commands[0].name, "the world");
  EXPECT_EQ(commands[2].name, "vehicle 8");
  EXPECT_EQ(commands[0].words[0], "/opt/bin/giveway-world");
  EXPECT_THAT(commands[0].words, Not(Contains("--id")));
  EXPECT_EQ(commands[1].words[0], "/opt/bin/giveway-vehicle");
  EXPECT_TRUE(Says(commands[1], "--id", "3"));
  EXPECT_TRUE(Says(commands[2], "--id", "8"));
}

TEST(MakeCommands, EveryoneIsToldTheSameScenarioDomainAndQos) {
  FleetSpec spec = OnDomainFive();
  spec.options.seed = 17;
  spec.options.behaviour = Behaviour::kLectureYield;
  spec.options.duration_s = 2.5;
  spec.options.lockstep = true;
  spec.options.interface = "any";
  for (const ChildCommand& command : ChildrenOf(spec, TwoVehicles())) {
    EXPECT_TRUE(Says(command, "--scenario", "/tmp/s.textproto"));
    EXPECT_TRUE(Says(command, "--domain", "5"));
    EXPECT_TRUE(Says(command, "--qos", "/tmp/q.xml"));
    EXPECT_TRUE(Says(command, "--interface", "any"));
    EXPECT_TRUE(Says(command, "--seed", "17"));
    EXPECT_TRUE(Says(command, "--behaviour", "lecture_yield"));
    EXPECT_TRUE(Says(command, "--duration", "2.5"));
    EXPECT_THAT(command.words, Contains("--lockstep"));
    EXPECT_EQ(command.kept_fd, 9);
  }
}

TEST(MakeCommands, EveryVehicleRecordsIntoAFileOfItsOwnIfAsked) {
  FleetSpec spec = OnDomainFive();
  spec.options.record_folder = "tapes";
  Scenario scenario = TwoVehicles();
  scenario.spawns.resize(1);
  spec.options.vehicles = 1;
  const auto commands = ChildrenOf(spec, scenario);
  ASSERT_THAT(commands, SizeIs(4));
  EXPECT_THAT(commands[0].words, Not(Contains("--record")));
  EXPECT_TRUE(Says(commands[1], "--record", "tapes/vehicle-3.recording"));
  EXPECT_TRUE(Says(commands[2], "--record", "tapes/vehicle-8.recording"));
  EXPECT_TRUE(Says(commands[3], "--record", "tapes/newcomer-1.recording"));
  for (const ChildCommand& command : ChildrenOf(OnDomainFive(), scenario)) {
    EXPECT_THAT(command.words, Not(Contains("--record")));
  }
}

TEST(MakeCommands, RecordingsAreSplitIfAsked) {
  FleetSpec spec = OnDomainFive();
  spec.options.record_split = "64MiB";
  EXPECT_THAT(ChildrenOf(spec, TwoVehicles())[1].words, Not(Contains("--record-split")));
  spec.options.record_folder = "tapes";
  const auto commands = ChildrenOf(spec, TwoVehicles());
  EXPECT_THAT(commands[0].words, Not(Contains("--record-split")));
  EXPECT_TRUE(Says(commands[2], "--record-split", "64MiB"));
}

TEST(MakeCommands, EveryVehicleIsImpairedIfAskedAndTheWorldIsNot) {
  FleetSpec spec = OnDomainFive();
  spec.options.impair = "loss=0.1";
  const auto commands = ChildrenOf(spec, TwoVehicles());
  EXPECT_THAT(commands[0].words, Not(Contains("--impair")));
  EXPECT_TRUE(Says(commands[1], "--impair", "loss=0.1"));
  EXPECT_TRUE(Says(commands[2], "--impair", "loss=0.1"));
  for (const ChildCommand& command : ChildrenOf(OnDomainFive(), TwoVehicles())) {
    EXPECT_THAT(command.words, Not(Contains("--impair")));
  }
}

TEST(MakeCommands, WhatTheOperatorLeftOutIsLeftToTheScenario) {
  for (const ChildCommand& command : ChildrenOf(OnDomainFive(), TwoVehicles())) {
    for (const char* flag : {"--seed", "--behaviour", "--duration", "--lockstep"}) {
      EXPECT_THAT(command.words, Not(Contains(flag)));
    }
  }
}

Scenario OpenFleet() {
  Scenario scenario = TwoVehicles();
  scenario.spawns.resize(5);
  return scenario;
}

TEST(MakeCommands, NewcomersOfAnOpenFleetAreStartedWithoutAnId) {
  FleetSpec spec = OnDomainFive();
  spec.options.vehicles = 3;
  const auto commands = ChildrenOf(spec, OpenFleet());
  ASSERT_THAT(commands, SizeIs(6));
  EXPECT_TRUE(Says(commands[2], "--id", "8"));
  for (std::size_t i = 3; i < 6; ++i) EXPECT_THAT(commands[i].words, Not(Contains("--id")));
  EXPECT_NE(commands[3].name, commands[4].name);
}

TEST(MakeCommands, AsManyNewcomersAsTheScenarioWaitsForOrOneASpawnPlace) {
  Scenario scenario = OpenFleet();
  EXPECT_EQ(NewcomerCount({}, scenario), 5U);
  scenario.start_with = 4;
  EXPECT_EQ(NewcomerCount({}, scenario), 2U);
  scenario.start_with = 1;
  EXPECT_EQ(NewcomerCount({}, scenario), 0U);
  EXPECT_EQ(NewcomerCount({}, TwoVehicles()), 0U);
}

TEST(MakeCommands, LogsAreKeptOnlyWhereAFolderIsNamed) {
  FleetSpec spec = OnDomainFive();
  EXPECT_EQ(ChildrenOf(spec, TwoVehicles())[0].log_file, "");
  spec.options.logs_folder = "logs";
  const auto commands = ChildrenOf(spec, TwoVehicles());
  EXPECT_EQ(commands[0].log_file, "logs/world.log");
  EXPECT_EQ(commands[2].log_file, "logs/vehicle-8.log");
}

TEST(MakeCommands, AddressEachProcessByWhatItIs) {
  FleetSpec spec = OnDomainFive();
  spec.options.vehicles = 1;
  std::vector<MemberId> members;
  for (const MemberCommand& command : MakeCommands(spec, OpenFleet())) {
    members.push_back(command.member);
  }
  EXPECT_THAT(members, ElementsAre(kTheWorld, MemberOf(VehicleId{3}), MemberOf(VehicleId{8}),
                                   MemberId{MemberKind::kNewcomer, 1}));
}

TEST(MakeCommands, ExtraWordsComeLastAndOnlyToWhomTheyAreFor) {
  FleetSpec spec = OnDomainFive();
  spec.options.impair = "loss=0.1";
  spec.options.vehicles = 1;
  spec.extra_words = {{kTheWorld, {"--threads", "2"}},
                      {MemberOf(VehicleId{8}), {"--hang-on-signal"}},
                      {{MemberKind::kNewcomer, 1}, {"--id", "9"}}};
  const auto commands = ChildrenOf(spec, OpenFleet());
  ASSERT_THAT(commands, SizeIs(4));
  EXPECT_EQ(commands[0].words.back(), "2");
  EXPECT_TRUE(Says(commands[0], "--threads", "2"));
  EXPECT_EQ(commands[1].words.back(), "3");
  EXPECT_EQ(commands[2].words.back(), "--hang-on-signal");
  EXPECT_TRUE(Says(commands[3], "--id", "9"));
}

TEST(MakeCommands, StartsAreStaggeredInTheOrderOfTheCommands) {
  using std::chrono::milliseconds;
  FleetSpec spec = OnDomainFive();
  for (const MemberCommand& command : MakeCommands(spec, TwoVehicles())) {
    EXPECT_EQ(command.start_after, Nanoseconds{0});
  }
  spec.stagger = milliseconds(50);
  const auto commands = MakeCommands(spec, TwoVehicles());
  ASSERT_THAT(commands, SizeIs(3));
  EXPECT_EQ(commands[0].start_after, Nanoseconds{0});
  EXPECT_EQ(commands[1].start_after, milliseconds(50));
  EXPECT_EQ(commands[2].start_after, milliseconds(100));
}

TEST(MakeCommands, LinesAndEnvironmentAreAsTheFleetWantsThem) {
  FleetSpec spec = OnDomainFive();
  for (const ChildCommand& command : ChildrenOf(spec, TwoVehicles())) {
    EXPECT_FALSE(command.hands_on_lines || command.flags_only);
  }
  spec.hands_on_lines = true;
  spec.flags_only = true;
  for (const ChildCommand& command : ChildrenOf(spec, TwoVehicles())) {
    EXPECT_TRUE(command.hands_on_lines && command.flags_only);
  }
}

}  // namespace
}  // namespace giveway::fleetctl
