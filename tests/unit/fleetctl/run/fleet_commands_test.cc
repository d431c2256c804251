#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/fleetctl/run/fleet_processes.h"

namespace giveway::fleetctl {
namespace {

using testing::Contains;
using testing::Not;
using testing::SizeIs;

Scenario TwoVehicles() {
  Scenario scenario;
  scenario.vehicles.resize(2);
  scenario.vehicles[0].id = VehicleId{3};
  scenario.vehicles[1].id = VehicleId{8};
  return scenario;
}

FleetCommand OnDomainFive() { return {"/opt/bin", "/tmp/s.textproto", 5, "/tmp/q.xml", 9}; }

// True if `flag` is followed by `value`.
bool Says(const ChildCommand& command, const std::string& flag, const std::string& value) {
  const auto found = std::ranges::find(command.words, flag);
  return found != command.words.end() && found + 1 != command.words.end() && found[1] == value;
}

TEST(MakeCommands, WorldComesFirstThenEveryVehicleByItsId) {
  const auto commands = MakeCommands({}, OnDomainFive(), TwoVehicles());
  ASSERT_THAT(commands, SizeIs(3));
  EXPECT_EQ(commands[0].words[0], "/opt/bin/giveway-world");
  EXPECT_THAT(commands[0].words, Not(Contains("--id")));
  EXPECT_EQ(commands[1].words[0], "/opt/bin/giveway-vehicle");
  EXPECT_TRUE(Says(commands[1], "--id", "3"));
  EXPECT_TRUE(Says(commands[2], "--id", "8"));
}

TEST(MakeCommands, EveryoneIsToldTheSameScenarioDomainAndQos) {
  RunOptions options;
  options.seed = 17;
  options.behaviour = Behaviour::kLectureYield;
  options.duration_s = 2.5;
  options.lockstep = true;
  options.interface = "any";
  for (const ChildCommand& command : MakeCommands(options, OnDomainFive(), TwoVehicles())) {
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
  RunOptions options;
  options.record_folder = "tapes";
  Scenario scenario = TwoVehicles();
  scenario.spawns.resize(1);
  options.vehicles = 1;
  const auto commands = MakeCommands(options, OnDomainFive(), scenario);
  ASSERT_THAT(commands, SizeIs(4));
  EXPECT_THAT(commands[0].words, Not(Contains("--record")));
  EXPECT_TRUE(Says(commands[1], "--record", "tapes/vehicle-3.recording"));
  EXPECT_TRUE(Says(commands[2], "--record", "tapes/vehicle-8.recording"));
  EXPECT_TRUE(Says(commands[3], "--record", "tapes/newcomer-1.recording"));
  for (const ChildCommand& command : MakeCommands({}, OnDomainFive(), scenario)) {
    EXPECT_THAT(command.words, Not(Contains("--record")));
  }
}

TEST(MakeCommands, RecordingsAreSplitIfAsked) {
  RunOptions options;
  options.record_split = "64MiB";
  EXPECT_THAT(MakeCommands(options, OnDomainFive(), TwoVehicles())[1].words,
              Not(Contains("--record-split")));
  options.record_folder = "tapes";
  const auto commands = MakeCommands(options, OnDomainFive(), TwoVehicles());
  EXPECT_THAT(commands[0].words, Not(Contains("--record-split")));
  EXPECT_TRUE(Says(commands[2], "--record-split", "64MiB"));
}

TEST(ErrorLines, AreThoseOfTheLogsErrorLevel) {
  EXPECT_TRUE(IsErrorLine("12:00:00.000 error   vehicle 2: the recording ends here: No space"));
  EXPECT_TRUE(IsErrorLine(R"({"time":"","steady_ns":1,"level":"error","process":"v","text":""})"));
  EXPECT_FALSE(IsErrorLine("12:00:00.000 info    vehicle 2: no error here"));
  EXPECT_FALSE(IsErrorLine(""));
}

TEST(MakeCommands, EveryVehicleIsImpairedIfAskedAndTheWorldIsNot) {
  RunOptions options;
  options.impair = "loss=0.1";
  const auto commands = MakeCommands(options, OnDomainFive(), TwoVehicles());
  EXPECT_THAT(commands[0].words, Not(Contains("--impair")));
  EXPECT_TRUE(Says(commands[1], "--impair", "loss=0.1"));
  EXPECT_TRUE(Says(commands[2], "--impair", "loss=0.1"));
  for (const ChildCommand& command : MakeCommands({}, OnDomainFive(), TwoVehicles())) {
    EXPECT_THAT(command.words, Not(Contains("--impair")));
  }
}

TEST(MakeCommands, WhatTheOperatorLeftOutIsLeftToTheScenario) {
  for (const ChildCommand& command : MakeCommands({}, OnDomainFive(), TwoVehicles())) {
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
  RunOptions options;
  options.vehicles = 3;
  const auto commands = MakeCommands(options, OnDomainFive(), OpenFleet());
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
  RunOptions options;
  EXPECT_EQ(MakeCommands(options, OnDomainFive(), TwoVehicles())[0].log_file, "");
  options.logs_folder = "logs";
  const auto commands = MakeCommands(options, OnDomainFive(), TwoVehicles());
  EXPECT_EQ(commands[0].log_file, "logs/world.log");
  EXPECT_EQ(commands[2].log_file, "logs/vehicle-8.log");
}

}  // namespace
}  // namespace giveway::fleetctl
