#include "services/observer/observer_flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <initializer_list>

#include "services/qos/qos_rules.h"
#include "tests/support/flag_twins.h"

namespace giveway {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::variant<ObserverFlags, int> Parse(std::initializer_list<const char*> flags,
                                       const OnlyFleet& only = {0, "", "no fleet runs"}) {
  std::vector<const char*> argv{"giveway-observer"};
  argv.insert(argv.end(), flags);
  return ParseObserverFlags(static_cast<int>(argv.size()), argv.data(), "Fast DDS",
                            [&only] { return only; });
}

TEST(ObserverFlags, HaveDefaultsAndReadWhatIsGiven) {
  const auto parsed = Parse({"--domain", "7", "--host-name", "fleet,robots.example"});
  ASSERT_TRUE(std::holds_alternative<ObserverFlags>(parsed));
  const auto& flags = std::get<ObserverFlags>(parsed);
  EXPECT_EQ(flags.domain, 7U);
  EXPECT_EQ(flags.port, 8080U);
  EXPECT_EQ(flags.address, "127.0.0.1");
  EXPECT_EQ(flags.foxglove_port, 0U);
  EXPECT_EQ(flags.host_names, (std::vector<std::string>{"fleet", "robots.example"}));
}

TEST(ObserverFlags, AreRefusedInWords) {
  for (const auto& wrong : {std::initializer_list<const char*>{},
                            {"--domain", "0"},
                            {"--domain", "7", "--port", "70000"},
                            {"--domain", "7", "--foxglove-port", "0"},
                            {"--domain", "7", "--foxglove-port", "8080"},
                            {"--domain", "7", "--log-level", "loud"},
                            {"--domain", "7", "--ros2", "--ros2-rate", "0"},
                            {"--domain", "7", "--ros2", "--ros2-domain", "100"},
                            {"--domain", "7", "--nonsense", "1"}}) {
    const auto parsed = Parse(wrong);
    ASSERT_TRUE(std::holds_alternative<int>(parsed));
    EXPECT_EQ(std::get<int>(parsed), 2);
  }
}

// Regression: GIVEWAY_ROS2 was taken for a misspelt GIVEWAY_QOS.
TEST(ObserverFlags, HaveTwinsThatTheRulesOfVariablesKnow) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(std::get<int>(Parse({"--help"})), 0);
  const auto twins = test::FlagTwins(::testing::internal::GetCapturedStdout());
  EXPECT_GT(twins.size(), 15U);
  for (const std::string& twin : twins) EXPECT_THAT(qos::OwnVariables(), Contains(twin));
}

TEST(ObserverFlags, TakeDomainAndInterfaceOfTheOnlyFleet) {
  const OnlyFleet only{42, "eth7", ""};
  const auto parsed = Parse({}, only);
  ASSERT_TRUE(std::holds_alternative<ObserverFlags>(parsed));
  EXPECT_EQ(std::get<ObserverFlags>(parsed).domain, 42U);
  EXPECT_EQ(std::get<ObserverFlags>(parsed).interface, "eth7");
  EXPECT_EQ(std::get<ObserverFlags>(Parse({"--interface", "lo"}, only)).interface, "lo");
  EXPECT_EQ(std::get<ObserverFlags>(Parse({"--domain", "7"}, only)).domain, 7U);
  EXPECT_EQ(std::get<ObserverFlags>(Parse({"--domain", "7"}, only)).interface, "127.0.0.1");
}

TEST(ObserverFlags, Ros2IsOffUnlessAskedFor) {
  EXPECT_FALSE(std::get<ObserverFlags>(Parse({"--domain", "7"})).ros2);
  const auto parsed =
      Parse({"--domain", "7", "--ros2", "--ros2-rate", "2.5", "--ros2-domain", "42"});
  ASSERT_TRUE(std::holds_alternative<ObserverFlags>(parsed));
  const auto& flags = std::get<ObserverFlags>(parsed);
  EXPECT_TRUE(flags.ros2);
  EXPECT_EQ(flags.ros2_rate_hz, 2.5);
  EXPECT_EQ(flags.ros2_domain, 42U);
}

TEST(ObserverFlags, SayWhyThereIsNoFleetToTake) {
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(std::holds_alternative<int>(Parse({}, {0, "", "several fleets run here"})));
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("several fleets run here"));
}

TEST(ObserverFlags, AFlagThatWasProbablyMeantIsNamed) {
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(std::holds_alternative<int>(Parse({"--domian", "7"})));
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("did you mean '--domain'?"));
}

TEST(ObserverFlags, AHealthQuestionNeedsNoDomain) {
  const auto parsed = Parse({"--health", "live", "--port", "9000"});
  ASSERT_TRUE(std::holds_alternative<ObserverFlags>(parsed));
  EXPECT_EQ(std::get<ObserverFlags>(parsed).ask_health, "live");
}

TEST(ObserverFlags, HaveTwinsInTheEnvironment) {
  setenv("GIVEWAY_DOMAIN", "9", 1);
  setenv("GIVEWAY_FOXGLOVE_PORT", "8765", 1);
  const auto parsed = Parse({});
  unsetenv("GIVEWAY_DOMAIN");
  unsetenv("GIVEWAY_FOXGLOVE_PORT");
  ASSERT_TRUE(std::holds_alternative<ObserverFlags>(parsed));
  EXPECT_EQ(std::get<ObserverFlags>(parsed).domain, 9U);
  EXPECT_EQ(std::get<ObserverFlags>(parsed).foxglove_port, 8765U);
}

}  // namespace
}  // namespace giveway
