#include "services/node/interface_check.h"

#include <gtest/gtest.h>

namespace giveway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class InterfaceCheckTest : public ::testing::Test {
 protected:
  std::string change_ = "eth0 has another address";
  int looks_ = 0;
  InterfaceCheck check_{[this] {
    ++looks_;
    return change_;
  }};
};

// A world and an observer stayed deaf for ever, and said that they were ready.
TEST_F(InterfaceCheckTest, OneThatHearsNothingEndsWhereItsInterfaceIsAnother) {
  EXPECT_FALSE(check_.MustEnd(seconds(10), true));
  EXPECT_FALSE(check_.MustEnd(milliseconds(11'999), false));
  EXPECT_TRUE(check_.MustEnd(seconds(12), false));
}

TEST_F(InterfaceCheckTest, OneThatHearsDoesNotLook) {
  for (int second = 1; second <= 60; ++second) {
    EXPECT_FALSE(check_.MustEnd(seconds(second), true));
  }
  EXPECT_EQ(looks_, 0);
}

TEST_F(InterfaceCheckTest, OneWhoseInterfaceIsThereStaysAndLooksOnceASecond) {
  change_.clear();
  for (int turn = 0; turn < 100; ++turn) {
    EXPECT_FALSE(check_.MustEnd(seconds(10) + turn * milliseconds(50), false));
  }
  EXPECT_EQ(looks_, 5);
}

}  // namespace
}  // namespace giveway
