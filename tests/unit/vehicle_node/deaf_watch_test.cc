#include "services/vehicle_node/deaf_watch.h"

#include <gtest/gtest.h>

#include <chrono>

namespace giveway {
namespace {

SteadyTime At(int seconds) { return std::chrono::seconds(seconds); }

TEST(DeafWatch, AsksForANewParticipantWhereTheWorldSpeaksForTenSecondsUnheard) {
  DeafWatch watch(At(0));
  EXPECT_FALSE(watch.Look(At(1), true, true));
  EXPECT_FALSE(watch.Look(At(10), false, true));
  EXPECT_TRUE(watch.Look(At(11), false, true));
}

TEST(DeafWatch, WaitsForAWorldThatIsSilentItself) {
  DeafWatch watch(At(0));
  EXPECT_FALSE(watch.Look(At(1), true, true));
  EXPECT_FALSE(watch.Look(At(100), false, false));
  EXPECT_FALSE(watch.Look(At(109), false, true)) << "back a moment ago";
  EXPECT_TRUE(watch.Look(At(110), false, true));
}

TEST(DeafWatch, OfAProcessThatNeverHeardAnythingAsksOnceAMinute) {
  DeafWatch watch(At(0));
  for (int now = 1; now < 60; ++now) EXPECT_FALSE(watch.Look(At(now), false, true)) << now;
  EXPECT_TRUE(watch.Look(At(60), false, true));
}

}  // namespace
}  // namespace giveway
