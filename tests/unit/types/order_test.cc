#include <gtest/gtest.h>

#include "services/types/beacon.h"

namespace giveway {
namespace {

OrderKey Key(std::uint32_t waited, std::uint32_t bucket, std::uint32_t id) {
  return {.waited_ticks = waited, .speed_bucket = bucket, .vehicle = VehicleId{id}};
}

TEST(Order, TheFasterGoesFirst) { EXPECT_TRUE(GoesFirst(Key(0, 8, 2), Key(0, 6, 1))); }

TEST(Order, EqualSpeedsAreBrokenByTheLowerId) {
  EXPECT_TRUE(GoesFirst(Key(0, 6, 1), Key(0, 6, 2)));
  EXPECT_FALSE(GoesFirst(Key(0, 6, 2), Key(0, 6, 1)));
}

TEST(Order, WhoWaitedLongestGoesFirstWhateverItsSpeed) {
  EXPECT_TRUE(GoesFirst(Key(500, 1, 9), Key(400, 9, 1)));
  EXPECT_TRUE(GoesFirst(Key(400, 1, 9), Key(0, 9, 1)));
}

TEST(Order, IsStrictAndTotalOverDistinctIds) {
  const OrderKey keys[] = {Key(0, 1, 1), Key(0, 1, 2), Key(0, 2, 3), Key(7, 1, 4), Key(9, 0, 5)};
  for (const OrderKey& a : keys) {
    EXPECT_FALSE(GoesFirst(a, a));
    for (const OrderKey& b : keys) {
      if (a != b) {
        EXPECT_NE(GoesFirst(a, b), GoesFirst(b, a));
      }
      for (const OrderKey& c : keys) {
        if (GoesFirst(a, b) && GoesFirst(b, c)) {
          EXPECT_TRUE(GoesFirst(a, c));
        }
      }
    }
  }
}

// 4 is blocked by 1 and 1 by 33: all inherit the key of 4, and only 33 can clear the path.
TEST(Order, WhoLendsItsKeyComesAfterWhomItIsLentTo) {
  const OrderKey lent = Key(0, 9, 4);
  EXPECT_TRUE(ComesFirst(lent, VehicleId{33}, lent, VehicleId{4}));
  EXPECT_FALSE(ComesFirst(lent, VehicleId{4}, lent, VehicleId{33}));
  EXPECT_TRUE(ComesFirst(lent, VehicleId{1}, lent, VehicleId{4}));
  EXPECT_TRUE(ComesFirst(lent, VehicleId{1}, lent, VehicleId{33}));
}

}  // namespace
}  // namespace giveway
