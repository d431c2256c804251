// The environment of a service: which variables it reads, and what it says of others.
#include "services/node/environment_check.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "services/config/flags.h"
#include "services/qos/qos_rules.h"
#include "tests/support/flag_twins.h"

namespace giveway {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::string HelpOf(ParsedFlags (*parse)(int, const char* const*, std::string_view)) {
  constexpr std::array kWords{"giveway", "--help"};
  ::testing::internal::CaptureStdout();
  parse(static_cast<int>(kWords.size()), kWords.data(), "Fast DDS");
  return ::testing::internal::GetCapturedStdout();
}

// Regression: GIVEWAY_ADMIN_KEY and others were none of ours, so misspelt ones were not noticed.
TEST(EnvironmentCheck, KnowsTheTwinOfEveryFlagOfAService) {
  for (const auto parse : {ParseVehicleFlags, ParseWorldFlags}) {
    const std::vector<std::string> twins = test::FlagTwins(HelpOf(parse));
    EXPECT_GT(twins.size(), 20U);
    for (const std::string& twin : twins) EXPECT_THAT(qos::OwnVariables(), Contains(twin));
  }
}

TEST(EnvironmentCheck, SaysWhichVariableIsMisspeltOrShutOut) {
  EXPECT_THAT(
      EnvironmentWarnings({"GIVEWAY_DISCOVERY_SERVERS=a", "GIVEWAY_DOMAIN=7", "PATH=/bin",
                           "ROS_DISCOVERY_SERVER=a"}),
      ElementsAre("environment: GIVEWAY_DISCOVERY_SERVERS: is set; GIVEWAY_DISCOVERY_SERVER is "
                  "meant? No service reads it; correct the name",
                  "environment: ROS_DISCOVERY_SERVER: is set: The services shut it out; other Fast "
                  "DDS programs of this shell find others; discoveryServersList of the profile "
                  "set"));
}

TEST(EnvironmentCheck, SaysNothingOfAllOthers) {
  EXPECT_THAT(EnvironmentWarnings({"GIVEWAY_ROS2=true", "GIVEWAY_ROOT=/srv", "HOME=/", "=", ""}),
              IsEmpty());
}

}  // namespace
}  // namespace giveway
