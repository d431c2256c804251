// Numbers that are given as flags: what is none, or not within its range, is refused in words.
#include "services/fleetctl/args/flag_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace giveway::fleetctl {
namespace {

using testing::HasSubstr;

class FlagChecksTest : public testing::Test {
 protected:
  FlagChecksTest() { app_.add_option("--cores", cores_, "Of a host")->check(Between(0.1, 1024)); }

  std::string Refusal(const std::string& text) {
    try {
      app_.parse("--cores '" + text + "'");
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return "accepted";
  }

  CLI::App app_;
  double cores_ = 0;
};

TEST_F(FlagChecksTest, ANumberWithinTheRangeIsTaken) {
  for (const char* text : {"0.1", "8", "1024", "1e2"}) EXPECT_EQ(Refusal(text), "accepted") << text;
  EXPECT_EQ(cores_, 100);
}

TEST_F(FlagChecksTest, WhatIsNoFiniteNumberIsRefused) {
  const std::string digits(400, '9');
  for (const std::string& text : {std::string("nan"), std::string("-nan"), std::string("inf"),
                                  std::string("1e999"), std::string("8 cores"), digits}) {
    EXPECT_THAT(Refusal(text), HasSubstr("must be a number from 0.1 to 1024, not '" + text + "'"));
  }
}

TEST_F(FlagChecksTest, WhatIsOutOfTheRangeIsRefused) {
  for (const char* text : {"0", "0.09", "1025", "-1"}) {
    EXPECT_THAT(Refusal(text), HasSubstr("must be a number from 0.1 to 1024")) << text;
  }
}

TEST_F(FlagChecksTest, TheHelpNamesTheRangeAsItDoesOfOthers) {
  EXPECT_EQ(app_.get_option("--cores")->get_type_name(), "FLOAT:FLOAT in [0.1 - 1024]");
}

}  // namespace
}  // namespace giveway::fleetctl
