// When the search for the processes of a fleet ends.
#include "services/fleetctl/qos/settling.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using std::chrono::seconds;

constexpr SteadyTime kStart = seconds(100);
constexpr Settling::Patience kPatience{.quiet = seconds(2), .limit = seconds(10), .at_least = 1};

TEST(Settling, EndsWhenNothingMoreIsFoundForAWhile) {
  Settling search(kPatience, kStart);
  EXPECT_FALSE(search.Take(1, kStart + seconds(1)));
  EXPECT_FALSE(search.Take(2, kStart + seconds(2)));
  EXPECT_FALSE(search.Take(2, kStart + seconds(3)));
  EXPECT_TRUE(search.Take(2, kStart + seconds(4)));
}

// On a busy machine the first process of a fleet may be found late: that is no reason to say that
// there is none.
TEST(Settling, OfASearchThatFoundNothingOnlyTheLimitEnds) {
  Settling search(kPatience, kStart);
  EXPECT_FALSE(search.Take(0, kStart + seconds(9)));
  EXPECT_TRUE(search.Take(0, kStart + seconds(10)));
}

TEST(Settling, ThatMayFindNothingEndsQuietly) {
  Settling search({.quiet = seconds(2), .limit = seconds(10)}, kStart);
  EXPECT_FALSE(search.Take(0, kStart + seconds(1)));
  EXPECT_TRUE(search.Take(0, kStart + seconds(2)));
}

TEST(Settling, EndsAtTheLimitThoughMoreIsFound) {
  Settling search(kPatience, kStart);
  for (std::size_t second = 1; second < 10; ++second) {
    EXPECT_FALSE(search.Take(second, kStart + seconds(second)));
  }
  EXPECT_TRUE(search.Take(10, kStart + seconds(10)));
}

}  // namespace
}  // namespace giveway::fleetctl
