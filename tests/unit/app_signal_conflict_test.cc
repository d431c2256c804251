#include <gtest/gtest.h>

#include <cmath>

#include "services/app/signal_conflict.h"
#include "services/types/random.h"

namespace giveway::app {
namespace {

SignalPlan Plan(double green_s, double yellow_s, double red_s, double offset_s) {
  SignalPlan plan;
  plan.green_s = green_s;
  plan.yellow_s = yellow_s;
  plan.red_s = red_s;
  plan.offset_s = offset_s;
  return plan;
}

TEST(SignalConflict, OppositeHalvesOfOneCycleNeverMeet) {
  EXPECT_FALSE(GoTogether(Plan(10, 3, 13, 0), Plan(10, 3, 13, 13)));
  EXPECT_FALSE(GoTogether(Plan(10, 3, 13, 13), Plan(10, 3, 13, 0)));
}

TEST(SignalConflict, ASplitSecondTogetherIsTogether) {
  EXPECT_TRUE(GoTogether(Plan(10, 3, 13, 0), Plan(10, 3, 13, 13.001)));
  EXPECT_TRUE(GoTogether(Plan(10, 3, 13, 0), Plan(10, 3, 13, 12.999)));
}

TEST(SignalConflict, YellowCountsAsGreenDoes) {
  EXPECT_TRUE(GoTogether(Plan(10, 3, 13, 0), Plan(10, 3, 13, 15)));
  EXPECT_FALSE(GoTogether(Plan(10, 1, 15, 0), Plan(10, 1, 15, 15)));
}

TEST(SignalConflict, AnOffsetOfManyCyclesIsTheSameOffset) {
  EXPECT_FALSE(GoTogether(Plan(10, 3, 13, 26 * 1000), Plan(10, 3, 13, 13)));
}

// 60 s and 40 s: one starts anew 20 s before or behind the other, in turn.
TEST(SignalConflict, CyclesOfDifferentLengthsAreFollowedAsLongAsTheyDrift) {
  EXPECT_FALSE(GoTogether(Plan(7, 3, 50, 0), Plan(7, 3, 30, 10)));
  EXPECT_TRUE(GoTogether(Plan(7, 3, 50, 0), Plan(8, 3, 30, 10)));
  EXPECT_TRUE(GoTogether(Plan(2, 1, 50, 0), Plan(2, 1, 50.001, 25)));
}

bool Goes(const SignalPlan& plan, double time_s) {
  const double cycle_s = plan.green_s + plan.yellow_s + plan.red_s;
  return std::fmod(time_s + plan.offset_s, cycle_s) < plan.green_s + plan.yellow_s;
}

// Whole seconds: half a second past each of them shows all there is.
TEST(SignalConflict, AgreesWithWatchingBothLongEnough) {
  Random random(3);
  const auto whole = [&](double low, double high) { return std::floor(random.Uniform(low, high)); };
  int together = 0;
  for (int pair = 0; pair < 500; ++pair) {
    const SignalPlan a = Plan(whole(1, 6), 1, whole(1, 20), whole(0, 30));
    const SignalPlan b = Plan(whole(1, 6), 1, whole(1, 20), whole(0, 30));
    bool seen = false;
    for (int second = 0; second < 30 * 30 && !seen; ++second) {
      seen = Goes(a, second + 0.5) && Goes(b, second + 0.5);
    }
    EXPECT_EQ(GoTogether(a, b), seen) << pair;
    together += seen;
  }
  EXPECT_GT(together, 100);
  EXPECT_LT(together, 499);
}

}  // namespace
}  // namespace giveway::app
