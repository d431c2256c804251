// The log of a child on a disk that is full for a while.
#include "services/fleetctl/process/child_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/full_disk.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::IsEmpty;

class ChildLogTest : public testing::Test {
 protected:
  std::string Written() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }

  TempFolder folder_;
  const std::string path_ = folder_.Path() + "/vehicle-2.log";
};

TEST_F(ChildLogTest, ItContinuesOnceTheDiskHasRoomAgainAndSaysWhatItLacks) {
  ChildLog log;
  ASSERT_TRUE(log.Open(path_));
  log.Append("one\n");
  {
    const test::FullDisk full(6);
    log.Append("two\n");
    EXPECT_THAT(log.TakeComplaints(),
                ElementsAre(path_ + ": cannot be written: File too large; it lacks what is said "
                                    "until it can"));
    log.Append("three\n");
    EXPECT_THAT(log.TakeComplaints(), IsEmpty()) << "said once";
  }
  log.Append("four\n");
  EXPECT_EQ(Written(), "one\ntwfour\n");
  log.End();
  EXPECT_THAT(log.TakeComplaints(), ElementsAre(path_ + ": 8 bytes are missing"));
  log.End();
  EXPECT_THAT(log.TakeComplaints(), IsEmpty());
}

TEST_F(ChildLogTest, WhatIsNotTakenIsSaidAtTheEnd) {
  testing::internal::CaptureStderr();
  {
    ChildLog log;
    ASSERT_TRUE(log.Open("/dev/full"));
    log.Append("12345");
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              EndsWith("\n/dev/full: 5 bytes are missing\n"));
}

TEST_F(ChildLogTest, OneThatTakesAllHasNothingToSay) {
  ChildLog log;
  ASSERT_TRUE(log.Open(path_));
  log.Append("one\n");
  log.End();
  EXPECT_THAT(log.TakeComplaints(), IsEmpty());
  EXPECT_FALSE(log.Open(folder_.Path() + "/none/vehicle-2.log"));
}

}  // namespace
}  // namespace giveway::fleetctl
