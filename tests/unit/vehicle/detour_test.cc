// A detour round standing obstacles: it is found where a coarse search finds one, and never leads
// through a body.
#include "services/vehicle/decision/detour.h"

#include <gtest/gtest.h>

#include <vector>

#include "services/types/math/math.h"

namespace giveway {
namespace {

constexpr double kRoom_m = 0.65;

// Discs side by side, open towards the west: a pocket to back out of.
std::vector<KeepOut> Bag() {
  std::vector<KeepOut> discs;
  for (int i = -2; i <= 2; ++i) discs.push_back({{2, 1.0 * i}, kRoom_m});
  for (int i = 0; i < 2; ++i) {
    discs.push_back({{1.0 * i, 2}, kRoom_m});
    discs.push_back({{1.0 * i, -2}, kRoom_m});
  }
  return discs;
}

TEST(Detour, IsTheStraightWayWhereNothingStands) {
  const auto turn = FirstTurn({}, {3, 0}, {});
  ASSERT_TRUE(turn);
  EXPECT_NEAR(turn->x, 3, 0.2);
  EXPECT_NEAR(turn->y, 0, 0.2);
}

TEST(Detour, TowardsWhatIsFarItGoesToTheEdgeOfTheMap) {
  const auto turn = FirstTurn({}, {0, 100}, {});
  ASSERT_TRUE(turn);
  EXPECT_NEAR(turn->y, 5, 0.3);
}

TEST(Detour, LeadsOutOfABagAndRoundIt) {
  const std::vector<KeepOut> discs = Bag();
  Vec2 at{1, 0};
  for (int leg = 0; leg < 40 && Norm(at - Vec2{4, 0}) > 0.3; ++leg) {
    const auto turn = FirstTurn(at, {4, 0}, discs);
    ASSERT_TRUE(turn);
    const Vec2 way = *turn - at;
    for (double share = 0; share <= 1; share += 0.01) {
      for (const KeepOut& disc : discs) {
        ASSERT_GT(Norm(at + share * way - disc.centre_world), 0.89 * disc.radius_m);
      }
    }
    at = *turn;
  }
  EXPECT_LT(Norm(at - Vec2{4, 0}), 0.3);
}

TEST(Detour, ComesAsNearAsItCanWhereThereIsNoWay) {
  std::vector<KeepOut> ring;
  for (int i = 0; i < 24; ++i) {
    ring.push_back({{2 * Cos(2 * kPi * i / 24 - kPi), 2 * Sin(2 * kPi * i / 24 - kPi)}, kRoom_m});
  }
  const auto turn = FirstTurn({}, {4, 0}, ring);
  ASSERT_TRUE(turn);
  EXPECT_GT(turn->x, 1);
  EXPECT_LT(Norm(*turn), 1.5);
}

TEST(Detour, GetsOutFromBesideABody) {
  const std::vector<KeepOut> discs = {{{0.6, 0}, kRoom_m}};
  const auto turn = FirstTurn({}, {3, 0}, discs);
  ASSERT_TRUE(turn);
  EXPECT_LT(Dot(*turn, {1, 0}), Norm(*turn));
}

}  // namespace
}  // namespace giveway
