// All that is wrong with what a service starts with, at once.
#include "services/node/start_inputs.h"

#include <gmock/gmock.h>

#include "services/config/problem.h"
#include "services/node/service_run.h"

namespace giveway {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kNoSet = "/no_such/set.xml";
constexpr const char* kNoKey = "/no_such/key";

ServiceFlags WrongFlags() {
  ServiceFlags flags;
  flags.qos = kNoSet;
  flags.admin_key = kNoKey;
  return flags;
}

std::string ThrownBy(const std::function<void()>& start) {
  try {
    start();
  } catch (const StartError& error) {
    return error.what();
  }
  return "nothing";
}

int WithoutScenario() {
  throw InputError({{"lanes.textproto", 7, "spawn[0]", "", "is missing", "write it"}});
}

// Regression: each was said only once the one before it was right.
TEST(StartInputs, AScenarioThatIsWrongHidesNeitherProfilesNorKey) {
  const ServiceFlags flags = WrongFlags();
  EXPECT_THAT(
      ThrownBy([&] { LoadForStart(flags, WithoutScenario); }),
      AllOf(HasSubstr("lanes.textproto:7: spawn[0]"), HasSubstr(kNoSet), HasSubstr(kNoKey)));
}

TEST(StartInputs, ProfilesAndKeyAreReadBeforeAnythingElse) {
  const StopSignal stop;
  bool lived = false;
  const auto live = [&lived](const link::LinkOptions&, const std::function<void()>&) {
    lived = true;
    return LifeEnd{};
  };
  EXPECT_THAT(ThrownBy([&] { RunService(WrongFlags(), {}, stop, live); }),
              AllOf(HasSubstr(kNoSet), HasSubstr(kNoKey)));
  EXPECT_FALSE(lived);
}

TEST(StartInputs, WhatIsRightIsNotNamed) {
  ServiceFlags flags = WrongFlags();
  flags.admin_key.clear();
  flags.qos = GIVEWAY_QOS_SETS "/default.xml";
  EXPECT_THAT(ThrownBy([&] { LoadForStart(flags, WithoutScenario); }),
              AllOf(HasSubstr("spawn[0]"), Not(HasSubstr("default.xml"))));
  EXPECT_EQ(LoadForStart(flags, [] { return 7; }), 7);
}

}  // namespace
}  // namespace giveway
