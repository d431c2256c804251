#include <gtest/gtest.h>

#include "services/types/beacon.h"

namespace giveway {
namespace {

PriorityKey Key(std::uint32_t waited, std::uint32_t bucket, std::uint32_t id) {
  return {.waited_ticks = waited, .speed_bucket = bucket, .vehicle = VehicleId{id}};
}

TEST(Order, TheFasterGoesFirst) { EXPECT_TRUE(PrecedesByKey(Key(0, 8, 2), Key(0, 6, 1))); }

TEST(Order, EqualSpeedsAreBrokenByTheLowerId) {
  EXPECT_TRUE(PrecedesByKey(Key(0, 6, 1), Key(0, 6, 2)));
  EXPECT_FALSE(PrecedesByKey(Key(0, 6, 2), Key(0, 6, 1)));
}

TEST(Order, WhoWaitedLongestGoesFirstWhateverItsSpeed) {
  EXPECT_TRUE(PrecedesByKey(Key(500, 1, 9), Key(400, 9, 1)));
  EXPECT_TRUE(PrecedesByKey(Key(400, 1, 9), Key(0, 9, 1)));
}

TEST(Order, IsStrictAndTotalOverDistinctIds) {
  const PriorityKey keys[] = {Key(0, 1, 1), Key(0, 1, 2), Key(0, 2, 3), Key(7, 1, 4), Key(9, 0, 5)};
  for (const PriorityKey& a : keys) {
    EXPECT_FALSE(PrecedesByKey(a, a));
    for (const PriorityKey& b : keys) {
      if (a != b) {
        EXPECT_NE(PrecedesByKey(a, b), PrecedesByKey(b, a));
      }
      for (const PriorityKey& c : keys) {
        if (PrecedesByKey(a, b) && PrecedesByKey(b, c)) {
          EXPECT_TRUE(PrecedesByKey(a, c));
        }
      }
    }
  }
}

// 4 is blocked by 1 and 1 by 33: all inherit the key of 4, and only 33 can clear the path.
TEST(Order, WhoLendsItsKeyComesAfterWhomItIsLentTo) {
  const PriorityKey inherited = Key(0, 9, 4);
  EXPECT_TRUE(HasPriority(inherited, VehicleId{33}, inherited, VehicleId{4}));
  EXPECT_FALSE(HasPriority(inherited, VehicleId{4}, inherited, VehicleId{33}));
  EXPECT_TRUE(HasPriority(inherited, VehicleId{1}, inherited, VehicleId{4}));
  EXPECT_TRUE(HasPriority(inherited, VehicleId{1}, inherited, VehicleId{33}));
}

}  // namespace
}  // namespace giveway
