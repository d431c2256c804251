#include "services/fleetctl/soak/host_faults/unread_log.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

class UnreadLogsTest : public testing::Test {
 protected:
  // Of one process, of which 900 bytes were read before and 10 waited.
  UnreadLogsTest() { logs_.Begin(fault_, {100, {.read = 900, .unread = 10}}); }
  std::string Effect(const LogSeen& now) const { return logs_.EffectOf(fault_, now); }
  std::string WhyNothing(const LogSeen& now) const { return logs_.WhyNothing(fault_, now); }
  faults::Fault fault_;
  UnreadLogs logs_;
};

TEST_F(UnreadLogsTest, WhatIsWrittenWaits) {
  EXPECT_EQ(Effect({100, {.read = 900, .unread = 10}}), "");
  EXPECT_EQ(Effect({100, {.read = 900, .unread = 322}}), "312 bytes of its log wait for a reader");
  EXPECT_EQ(logs_.EffectOf({}, {100, {.read = 900, .unread = 322}}), "") << "of another fault";
}

// One that was started again has a reader.
TEST_F(UnreadLogsTest, WhatAnotherProcessWritesDoesNotCount) {
  EXPECT_EQ(Effect({101, {.read = 0, .unread = 322}}), "");
  EXPECT_EQ(WhyNothing({101, {.read = 900, .unread = 10}}), "");
  EXPECT_EQ(WhyNothing({std::nullopt, {.read = 900, .unread = 10}}), "");
}

TEST_F(UnreadLogsTest, OfOneThatWritesNothingNothingIsMissing) {
  EXPECT_EQ(WhyNothing({100, {.read = 900, .unread = 10}}), "it logged nothing meanwhile");
  EXPECT_EQ(WhyNothing({100, {.read = 900, .unread = 11}}), "");
}

TEST_F(UnreadLogsTest, OneThatIsReadAllTheSameIsNotSilent) {
  EXPECT_EQ(WhyNothing({100, {.read = 950, .unread = 10}}), "");
  EXPECT_EQ(Effect({100, {.read = 950, .unread = 0}}), "");
}

TEST_F(UnreadLogsTest, WhatIsOverHasNoEffect) {
  logs_.End(fault_);
  EXPECT_EQ(Effect({100, {.read = 900, .unread = 322}}), "");
  EXPECT_EQ(WhyNothing({100, {.read = 900, .unread = 10}}), "");
}

}  // namespace
}  // namespace giveway::fleetctl
