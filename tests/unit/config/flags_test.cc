#include "services/config/flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>
#include <vector>

#include "services/config/flag_values.h"
#include "services/runtime/restart.h"

namespace giveway {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::internal::CaptureStderr;
using ::testing::internal::CaptureStdout;
using ::testing::internal::GetCapturedStderr;
using ::testing::internal::GetCapturedStdout;

ParsedFlags Vehicle(std::vector<const char*> words) {
  words.insert(words.begin(), "giveway-vehicle");
  return ParseVehicleFlags(static_cast<int>(words.size()), words.data(), "Fast DDS 9.8.7");
}

ParsedFlags World(std::vector<const char*> words) {
  words.insert(words.begin(), "giveway-world");
  return ParseWorldFlags(static_cast<int>(words.size()), words.data(), "Fast DDS 9.8.7");
}

// The stderr of a command line that must end with exit code 2.
std::string Refusal(const std::vector<const char*>& words) {
  CaptureStderr();
  const ParsedFlags parsed = Vehicle(words);
  const std::string text = GetCapturedStderr();
  const int* code = std::get_if<int>(&parsed);
  EXPECT_TRUE(code != nullptr && *code == 2);
  return text;
}

// Sets an environment variable for the duration of a test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

TEST(Flags, WhatAVehicleGivesToItselfIsRefusedWhereItIsNone) {
  const std::string held = HoldText("resume", ToBytes({.session = {1, 2, 3, 4}, .order = 5}));
  const ParsedFlags parsed =
      Vehicle({"--scenario", "wall_only", "--domain", "7", "--resume", held.c_str()});
  EXPECT_EQ(std::get<ServiceFlags>(parsed).resume->order, 5U);
  const std::string spoilt = HoldText("resume", "giveway-resume-1\nnothing of the kind");
  for (const char* const file : {spoilt.c_str(), "/no/such/file", "/dev/null"}) {
    EXPECT_THAT(Refusal({"--scenario", "wall_only", "--domain", "7", "--resume", file}),
                HasSubstr(file));
  }
}

TEST(Flags, TheDefaultsNeedOnlyScenarioAndDomain) {
  const ParsedFlags parsed = Vehicle({"--scenario", "wall_only", "--domain", "7"});
  const ServiceFlags& flags = std::get<ServiceFlags>(parsed);
  EXPECT_EQ(flags.scenario, "wall_only");
  EXPECT_EQ(flags.domain, 7U);
  EXPECT_EQ(flags.interface, "127.0.0.1");
  EXPECT_THAT(flags.qos, ::testing::EndsWith("/qos/default.xml"));
  EXPECT_EQ(flags.id, 0U);
  EXPECT_FALSE(flags.seed || flags.behaviour || flags.duration_s || flags.lockstep);
  EXPECT_EQ(flags.log_format, "text");
  EXPECT_EQ(flags.log_level, "info");
}

TEST(Flags, ThePrintedScriptsCanBeAskedForByName) {
  const ParsedFlags parsed =
      Vehicle({"--scenario=s", "--domain", "7", "--behaviour", "lecture_printed"});
  EXPECT_EQ(std::get<ServiceFlags>(parsed).behaviour, Behaviour::kLecturePrinted);
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle({"--scenario=s", "--domain", "7"})).behaviour,
            std::nullopt);
}

TEST(Flags, EveryFlagReachesItsPlace) {
  const ParsedFlags parsed = Vehicle({"--scenario=s",  "--domain",   "99",          "--interface",
                                      "any",           "--qos",      "q.xml",       "--id",
                                      "4294967295",    "--seed",     "0",           "--behaviour",
                                      "lecture_yield", "--duration", "2.5",         "--lockstep",
                                      "--log-format",  "json",       "--log-level", "debug"});
  const ServiceFlags& flags = std::get<ServiceFlags>(parsed);
  EXPECT_EQ(flags.scenario, "s");
  EXPECT_EQ(flags.domain, 99U);
  EXPECT_EQ(flags.interface, "any");
  EXPECT_EQ(flags.qos, "q.xml");
  EXPECT_EQ(flags.id, 4294967295U);
  EXPECT_EQ(flags.seed, 0U);
  EXPECT_EQ(flags.behaviour, Behaviour::kLectureYield);
  EXPECT_EQ(flags.duration_s, 2.5);
  EXPECT_TRUE(flags.lockstep);
  EXPECT_EQ(flags.log_format, "json");
  EXPECT_EQ(flags.log_level, "debug");
}

// Regression: a switch with any value was on.
TEST(Flags, ASwitchWithAValueIsJudgedAsItsVariable) {
  const auto admin = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"--scenario=s", "--domain", "7"});
    return std::get<ServiceFlags>(World(std::move(words))).admin;
  };
  EXPECT_FALSE(admin({}));
  for (const char* const on : {"--admin", "--admin=1", "--admin=true"}) EXPECT_TRUE(admin({on}));
  for (const char* const off : {"--admin=0", "--admin=false"}) EXPECT_FALSE(admin({off}));
  EXPECT_FALSE(admin({"--admin", "--admin=false"}));
  EXPECT_THAT(Refusal({"--scenario=s", "--domain", "7", "--admin=banana"}),
              HasSubstr("--admin = banana: must be one of 0, 1, false, true"));
  const Variable twin("GIVEWAY_ADMIN", "1");
  EXPECT_TRUE(admin({}));
  EXPECT_FALSE(admin({"--admin=false"}));
}

TEST(Flags, OnlyTheWorldKeepsACheckpointAndOnlyIfAsked) {
  const std::vector<const char*> least{"--scenario", "s", "--domain", "1"};
  EXPECT_EQ(std::get<ServiceFlags>(World(least)).checkpoint, "");
  std::vector<const char*> words = least;
  words.insert(words.end(), {"--checkpoint", "state"});
  EXPECT_EQ(std::get<ServiceFlags>(World(words)).checkpoint, "state");
  EXPECT_THAT(Refusal(words), HasSubstr("--checkpoint"));
}

TEST(Flags, OnlyAVehicleRecordsAndOnlyIfAsked) {
  const std::vector<const char*> least{"--scenario", "s", "--domain", "1"};
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(least)).record, "");
  std::vector<const char*> words = least;
  words.insert(words.end(), {"--record", "tape"});
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(words)).record, "tape");
  CaptureStderr();
  EXPECT_EQ(std::get<int>(World(words)), 2);
  EXPECT_THAT(GetCapturedStderr(), HasSubstr("--record"));
  words.back() = "";
  EXPECT_THAT(Refusal(words), HasSubstr("must not be empty"));
  const Variable twin("GIVEWAY_RECORD", "other");
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(least)).record, "other");
  EXPECT_EQ(std::get<ServiceFlags>(World(least)).record, "");
}

TEST(Flags, ARecordingIsSplitBySizesOfThisWorld) {
  const std::vector<const char*> least{"--scenario", "s", "--domain", "1", "--record", "tape"};
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(least)).record_split, 0U);
  std::vector<const char*> words = least;
  words.insert(words.end(), {"--record-split", "64MiB"});
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(words)).record_split, 64ULL << 20U);
  for (const char* wrong : {"0", "-1", "1KiB", "64 MiB", "64mib", "1e9", "99999999999GiB", ""}) {
    words.back() = wrong;
    EXPECT_THAT(Refusal(words), HasSubstr("--record-split")) << wrong;
  }
  const Variable twin("GIVEWAY_RECORD_SPLIT", "100kB");
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(least)).record_split, 100000U);
}

TEST(Flags, ARingLastsSecondsAndIsNotSplitBySize) {
  std::vector<const char*> words{"--scenario", "s",    "--domain",      "1",
                                 "--record",   "tape", "--record-ring", "60"};
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(words)).record_ring, std::chrono::seconds(60));
  for (const char* wrong : {"4", "3601", "60s", "-1"}) {
    words.back() = wrong;
    EXPECT_THAT(Refusal(words), HasSubstr("--record-ring")) << wrong;
  }
  words.back() = "60";
  words.insert(words.end(), {"--record-split", "64MiB"});
  EXPECT_THAT(Refusal(words), HasSubstr("leave --record-split out"));
}

TEST(Flags, HowToRecordIsRefusedWhereNothingIsRecorded) {
  for (const auto& [flag, value] :
       {std::pair{"--record-ring", "60"}, {"--record-split", "64MiB"}}) {
    const std::vector<const char*> words{"--scenario", "s", "--domain", "1", flag, value};
    EXPECT_THAT(Refusal(words), AllOf(HasSubstr(flag), HasSubstr("give --record FILE")));
  }
}

TEST(Flags, ADurationMayHaveItsUnit) {
  const auto duration_s = [](const char* text) {
    return std::get<ServiceFlags>(Vehicle({"--scenario", "s", "--domain", "1", "--duration", text}))
        .duration_s;
  };
  EXPECT_EQ(duration_s("90"), 90);
  EXPECT_EQ(duration_s("90s"), 90);
  EXPECT_EQ(duration_s("1.5m"), 90);
  EXPECT_EQ(duration_s("1d"), 86400);
}

TEST(Flags, ProfilesAreAFileOrAShippedSet) {
  const auto qos = [](const char* text) {
    return std::get<ServiceFlags>(Vehicle({"--scenario", "s", "--domain", "1", "--qos", text})).qos;
  };
  EXPECT_THAT(qos("lossy_radio"), EndsWith("/qos/lossy_radio.xml"));
  EXPECT_EQ(qos("no_such_set"), "no_such_set");  // refused by what opens it
  EXPECT_EQ(qos("lossy_radio.xml"), "lossy_radio.xml");
  EXPECT_EQ(qos("/proc/self/fd/7"), "/proc/self/fd/7");
}

TEST(Flags, OnlyAVehicleIsImpairedAndOnlyIfAsked) {
  const std::vector<const char*> least{"--scenario", "s", "--domain", "1"};
  EXPECT_FALSE(std::get<ServiceFlags>(Vehicle(least)).impair);
  std::vector<const char*> words = least;
  words.insert(words.end(), {"--impair", "loss=0.25,seed=3"});
  const auto impaired = std::get<ServiceFlags>(Vehicle(words)).impair;
  ASSERT_TRUE(impaired && impaired->rules.size() == 1);
  EXPECT_EQ(impaired->rules[0].loss, 0.25);
  EXPECT_EQ(impaired->seed, 3U);
  EXPECT_FALSE(impaired->started);
  std::vector<const char*> since = words;
  since.insert(since.end(), {"--impair-since", "12345.678901"});
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(since)).impair->started, SteadyTime(12'345'678'901'000));
  CaptureStderr();
  EXPECT_EQ(std::get<int>(World(words)), 2);
  EXPECT_THAT(GetCapturedStderr(), HasSubstr("--impair"));
  words.back() = "loss=2,delay=5";
  const std::string text = Refusal(words);
  EXPECT_THAT(text, HasSubstr("--impair = loss=2,delay=5: loss = 2: must be a number between"));
  EXPECT_THAT(text, HasSubstr("delay = 5: must be a time with its unit"));
  const Variable twin("GIVEWAY_IMPAIR", "none");
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle(least)).impair, Impairment{});
  EXPECT_FALSE(std::get<ServiceFlags>(World(least)).impair);
}

TEST(Flags, OnlyAVehicleBeaconsWithoutAPartitionAndOnlyIfAsked) {
  const std::vector<const char*> least{"--scenario", "s", "--domain", "1"};
  EXPECT_FALSE(std::get<ServiceFlags>(Vehicle(least)).partition_free);
  std::vector<const char*> words = least;
  EXPECT_FALSE(std::get<ServiceFlags>(Vehicle(least)).hang_on_signal);
  words.push_back("--partition-free");
  words.push_back("--hang-on-signal");
  EXPECT_TRUE(std::get<ServiceFlags>(Vehicle(words)).partition_free);
  EXPECT_TRUE(std::get<ServiceFlags>(Vehicle(words)).hang_on_signal);
  EXPECT_TRUE(std::get<ServiceFlags>(Vehicle(words)).watchdog);
  words.push_back("--no-watchdog");
  EXPECT_FALSE(std::get<ServiceFlags>(Vehicle(words)).watchdog);
  CaptureStderr();
  EXPECT_EQ(std::get<int>(World(words)), 2);
  EXPECT_THAT(GetCapturedStderr(), HasSubstr("--partition-free"));
  const Variable twin("GIVEWAY_PARTITION_FREE", "1");
  EXPECT_TRUE(std::get<ServiceFlags>(Vehicle(least)).partition_free);
}

TEST(Flags, LeaveOutSharedMemoryAndNoOtherTransport) {
  std::vector<const char*> words{"--scenario", "s", "--domain", "1"};
  EXPECT_FALSE(std::get<ServiceFlags>(World(words)).leaves_out_shared_memory);
  words.insert(words.end(), {"--leave-out", "shared_memory"});
  EXPECT_TRUE(std::get<ServiceFlags>(Vehicle(words)).leaves_out_shared_memory);
  EXPECT_TRUE(std::get<ServiceFlags>(World(words)).leaves_out_shared_memory);
  words.back() = "udp";
  EXPECT_THAT(Refusal(words), HasSubstr("--leave-out"));
}

TEST(Flags, OnlyAVehicleOutlivesItsWorldAndOnlyIfAsked) {
  const std::vector<const char*> least{"--scenario", "s", "--domain", "1"};
  EXPECT_FALSE(std::get<ServiceFlags>(Vehicle(least)).stay);
  std::vector<const char*> words = least;
  words.push_back("--stay");
  EXPECT_TRUE(std::get<ServiceFlags>(Vehicle(words)).stay);
  CaptureStderr();
  EXPECT_EQ(std::get<int>(World(words)), 2);
  EXPECT_THAT(GetCapturedStderr(), HasSubstr("--stay"));
  const Variable twin("GIVEWAY_STAY", "true");
  EXPECT_TRUE(std::get<ServiceFlags>(Vehicle(least)).stay);
}

TEST(Flags, OnlyTheWorldSharesItsWorkAmongThreads) {
  const auto threads = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"--scenario", "s", "--domain", "1"});
    return std::get<ServiceFlags>(World(words)).threads;
  };
  EXPECT_EQ(threads({}), 1U);
  EXPECT_EQ(threads({"--threads", "256"}), 256U);
  const Variable twin("GIVEWAY_THREADS", "3");
  EXPECT_EQ(threads({}), 3U);
  EXPECT_EQ(threads({"--threads", "2"}), 2U);
  EXPECT_THAT(Refusal({"--scenario", "s", "--domain", "1", "--threads", "2"}),
              HasSubstr("--threads"));
  for (const char* wrong : {"0", "257", "-1", "2.5", "many"}) {
    CaptureStderr();
    EXPECT_EQ(std::get<int>(World({"--scenario", "s", "--domain", "1", "--threads", wrong})), 2);
    EXPECT_THAT(GetCapturedStderr(), HasSubstr("must be a whole number between 1 and 256"));
  }
}

TEST(Flags, EveryWrongValueIsNamedWithItsRange) {
  const std::string text = Refusal(
      {"--scenario",  "",     "--domain",    "100", "--id",         "0",   "--seed",      "-1",
       "--behaviour", "fast", "--duration",  "nan", "--log-format", "xml", "--log-level", "all",
       "--qos",       "",     "--interface", ""});
  for (const char* words :
       {"--scenario = \"\": is required", "--domain = 100: must be a whole number between 1 and 99",
        "--id = 0: must be a whole number between 1 and 4294967295",
        "--seed = -1: must be a whole number between 0 and 4294967295",
        "--behaviour = fast: must be one of cooperative, lecture_avoid",
        "--duration = nan: must be a time above 0 and at most 86400 s",
        "--log-format = xml: must be one of text, json", "--log-level = all: must be one of debug",
        "--qos = \"\": must not be empty", "--interface = \"\": must not be empty"}) {
    EXPECT_THAT(text, HasSubstr(words));
  }
}

TEST(Flags, NumbersWithATailAreRefused) {
  for (const char* domain : {"7x", " 7", "7.0", "0x7", "+7", "", "99999999999999999999"}) {
    EXPECT_THAT(Refusal({"--scenario", "s", "--domain", domain}), HasSubstr("--domain"));
  }
  for (const char* duration : {"1e400", "inf", "0", "1sm", "s", "2d"}) {
    EXPECT_THAT(Refusal({"--scenario", "s", "--domain", "1", "--duration", duration}),
                HasSubstr("--duration"));
  }
}

TEST(Flags, MissingOnesAreNamed) {
  const std::string text = Refusal({});
  EXPECT_THAT(text, HasSubstr("--scenario: is required"));
  EXPECT_THAT(text, HasSubstr("--domain: is required"));
}

TEST(Flags, UnknownFlagsAndMissingValuesAreRefused) {
  EXPECT_THAT(Refusal({"--fast"}), HasSubstr("--fast"));
  EXPECT_THAT(Refusal({"--domain"}), HasSubstr("--domain"));
  EXPECT_THAT(Refusal({"word"}), HasSubstr("word"));
  CaptureStderr();
  EXPECT_EQ(std::get<int>(World({"--scenario", "s", "--domain", "1", "--id", "1"})), 2);
  EXPECT_THAT(GetCapturedStderr(), HasSubstr("--id"));
}

TEST(Flags, ATwinInTheEnvironmentStandsInForAFlag) {
  const Variable domain("GIVEWAY_DOMAIN", "5");
  const Variable level("GIVEWAY_LOG_LEVEL", "error");
  const Variable lockstep("GIVEWAY_LOCKSTEP", "true");
  const ParsedFlags parsed = Vehicle({"--scenario", "s"});
  const ServiceFlags& flags = std::get<ServiceFlags>(parsed);
  EXPECT_EQ(flags.domain, 5U);
  EXPECT_EQ(flags.log_level, "error");
  EXPECT_TRUE(flags.lockstep);
}

TEST(Flags, TheFlagWinsOverItsTwin) {
  const Variable domain("GIVEWAY_DOMAIN", "500");
  EXPECT_EQ(std::get<ServiceFlags>(Vehicle({"--scenario", "s", "--domain", "6"})).domain, 6U);
}

TEST(Flags, AnEmptyVariableCountsAsUnset) {
  const Variable seed("GIVEWAY_SEED", "");
  EXPECT_FALSE(std::get<ServiceFlags>(Vehicle({"--scenario", "s", "--domain", "6"})).seed);
}

TEST(Flags, AWrongVariableIsRefusedByItsName) {
  const Variable domain("GIVEWAY_DOMAIN", "0");
  const Variable lockstep("GIVEWAY_LOCKSTEP", "yes");
  const std::string text = Refusal({"--scenario", "s"});
  EXPECT_THAT(text, HasSubstr("environment: GIVEWAY_DOMAIN = 0: must be a whole number"));
  EXPECT_THAT(text, HasSubstr("environment: GIVEWAY_LOCKSTEP = yes: must be one of 0, 1"));
}

TEST(Flags, HelpAndVersionEndWithZero) {
  CaptureStdout();
  EXPECT_EQ(std::get<int>(World({"--help"})), 0);
  EXPECT_THAT(GetCapturedStdout(), HasSubstr("--lockstep"));
  CaptureStdout();
  EXPECT_EQ(std::get<int>(Vehicle({"--version"})), 0);
  EXPECT_THAT(GetCapturedStdout(),
              ::testing::MatchesRegex("giveway-vehicle 0\\.[0-9.]*, Fast DDS 9\\.8\\.7\n"));
}

TEST(Flags, TheTwinOfAFlagIsSpeltInCapitals) {
  EXPECT_EQ(TwinOf("--log-level"), "GIVEWAY_LOG_LEVEL");
}

TEST(Flags, DiscoveryServersAreReadFromTheFlagOrItsTwin) {
  const auto parsed = Vehicle({"--scenario", "s", "--domain", "3", "--discovery-server", "a,b:7"});
  const auto& servers = std::get<ServiceFlags>(parsed).discovery_servers;
  EXPECT_EQ(ToText(servers), "a:11811,b:7");
  const Variable twin("GIVEWAY_DISCOVERY_SERVER", "a:x");
  EXPECT_THAT(Refusal({"--scenario", "s", "--domain", "3"}),
              HasSubstr("GIVEWAY_DISCOVERY_SERVER = a:x: \"x\" is no port from 1 to 65535"));
}

TEST(Flags, HealthIsServedOnlyWhereAPortIsNamed) {
  const ParsedFlags none = Vehicle({"--scenario", "wall_only", "--domain", "7"});
  EXPECT_EQ(std::get<ServiceFlags>(none).health_port, 0U);
  const Variable port("GIVEWAY_HEALTH_PORT", "9100");
  const ParsedFlags some =
      World({"--scenario", "wall_only", "--domain", "7", "--health-address", "0.0.0.0"});
  EXPECT_EQ(std::get<ServiceFlags>(some).health_port, 9100U);
  EXPECT_EQ(std::get<ServiceFlags>(some).health_address, "0.0.0.0");
  EXPECT_EQ(std::get<ServiceFlags>(some).ask_health, "");
}

TEST(Flags, AskingForHealthNeedsNothingButThePort) {
  const auto asked = [](const ParsedFlags& parsed) {
    return std::get<ServiceFlags>(parsed).ask_health;
  };
  EXPECT_EQ(asked(Vehicle({"--health", "--health-port", "9100"})), "ready");
  EXPECT_EQ(asked(World({"--health-port", "9100", "--health"})), "ready");
  EXPECT_EQ(asked(Vehicle({"--health", "live", "--health-port", "9100"})), "live");
  EXPECT_THAT(Refusal({"--health"}), HasSubstr("write --health-port"));
  EXPECT_THAT(Refusal({"--health", "well", "--health-port", "9100"}), HasSubstr("live, ready"));
  EXPECT_THAT(Refusal({"--health", "--health-port", "65536"}), HasSubstr("0 and 65535"));
}

}  // namespace
}  // namespace giveway
