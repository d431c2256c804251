#include "services/fleetctl/soak/observer_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

namespace giveway::fleetctl {
namespace {

SteadyTime At(int seconds) { return std::chrono::seconds(seconds); }

TEST(ObserverWatch, AsksForANewParticipantWhereNobodyOfARunningFleetIsHeard) {
  ObserverWatch watch;
  EXPECT_FALSE(watch.Update(At(10), true, true));
  EXPECT_FALSE(watch.Update(At(11), false, true));
  EXPECT_TRUE(watch.Update(At(12), false, true));
  EXPECT_EQ(watch.Count(), 1U);
  EXPECT_FALSE(watch.Update(At(13), true, true)) << "it helped";
}

TEST(ObserverWatch, ExpectsNothingOfAFleetThatIsGone) {
  ObserverWatch watch;
  EXPECT_FALSE(watch.Update(At(10), true, true));
  EXPECT_FALSE(watch.Update(At(60), false, false));
  EXPECT_FALSE(watch.Update(At(61), false, true)) << "back a moment ago";
}

TEST(ObserverWatch, AsksMoreAndMoreSeldomWhereItDoesNotHelp) {
  ObserverWatch watch;
  watch.Update(At(0), true, true);
  std::vector<int> due;
  for (int now = 1; now <= 120; ++now) {
    if (watch.Update(At(now), false, true)) due.push_back(now);
  }
  EXPECT_EQ(due, (std::vector<int>{2, 6, 14, 30, 62, 94}));
}

}  // namespace
}  // namespace giveway::fleetctl
