#include "services/vehicle_node/scan_watch.h"

#include <gtest/gtest.h>

#include <chrono>

namespace giveway {
namespace {

SteadyTime At(int seconds) { return std::chrono::seconds(seconds); }

TEST(ScanWatch, AsksForANewParticipantWhereTheWorldSpeaksForTenSecondsUnheard) {
  ScanWatch watch(At(0));
  EXPECT_FALSE(watch.Update(At(1), true, true));
  EXPECT_FALSE(watch.Update(At(10), false, true));
  EXPECT_TRUE(watch.Update(At(11), false, true));
}

TEST(ScanWatch, WaitsForAWorldThatIsSilentItself) {
  ScanWatch watch(At(0));
  EXPECT_FALSE(watch.Update(At(1), true, true));
  EXPECT_FALSE(watch.Update(At(100), false, false));
  EXPECT_FALSE(watch.Update(At(109), false, true)) << "back a moment ago";
  EXPECT_TRUE(watch.Update(At(110), false, true));
}

TEST(ScanWatch, OfAProcessThatNeverHeardAnythingAsksOnceAMinute) {
  ScanWatch watch(At(0));
  for (int now = 1; now < 60; ++now) EXPECT_FALSE(watch.Update(At(now), false, true)) << now;
  EXPECT_TRUE(watch.Update(At(60), false, true));
}

}  // namespace
}  // namespace giveway
