#include "services/fleetctl/soak/near_misses.h"

#include <gmock/gmock.h>

namespace giveway::fleetctl {
namespace {

using ::testing::SizeIs;

constexpr VehicleId kLeft{1};
constexpr VehicleId kRight{2};

NearMisses OfTwo() { return NearMisses({{kLeft, 0.25}, {kRight, 0.25}}); }

// Both at one time, `gap_m` shell to shell along x.
void At(double time_s, double gap_m, NearMisses* misses, double lag_s = 0) {
  Truth left;
  left.vehicle = kLeft;
  left.time_s = time_s;
  Truth right = left;
  right.vehicle = kRight;
  right.world_from_body.position_world.x = 0.5 + gap_m;
  misses->Fold(std::vector<Truth>{left, right}, lag_s);
}

TEST(NearMisses, CountAnEncounterOnceAtItsNarrowest) {
  NearMisses misses = OfTwo();
  for (const double gap_m : {1.0, 0.14, 0.05, 0.12, 0.2, 1.0}) At(gap_m, gap_m, &misses);
  ASSERT_THAT(misses.Narrowest(), SizeIs(1));
  EXPECT_NEAR(misses.Narrowest().front().distance_m, 0.05, 1e-12);
  EXPECT_EQ(misses.Count(), 1U);
  At(9, 0.1, &misses);
  EXPECT_EQ(misses.Count(), 2U);
  EXPECT_THAT(misses.Narrowest(), SizeIs(2));
}

// A world that was gone came back with a time that lags, and its near misses were listed too early.
TEST(NearMisses, HaveTheTimeOfTheSoakAndNotOfTheWorld) {
  NearMisses misses = OfTwo();
  At(5, 0.1, &misses, 2.5);
  EXPECT_EQ(misses.Narrowest().front().time_s, 7.5);
}

TEST(NearMisses, AreNotMadeOfWhoPassesFartherAway) {
  NearMisses misses = OfTwo();
  At(1, 0.16, &misses);
  EXPECT_EQ(misses.Count(), 0U);
  EXPECT_NEAR(misses.Nearest()->distance_m, 0.16, 1e-12);
}

TEST(NearMisses, AreNotMadeOfABodyThatIsGoneOrWasLongAgo) {
  NearMisses misses = OfTwo();
  Truth left;
  left.vehicle = kLeft;
  misses.Fold(std::vector<Truth>{left});
  Truth right;
  right.vehicle = kRight;
  right.time_s = 5;
  misses.Fold(std::vector<Truth>{right});
  EXPECT_FALSE(misses.Nearest());
  left.present = false;
  left.time_s = 5;
  misses.Fold(std::vector<Truth>{left, right});
  EXPECT_FALSE(misses.Nearest());
}

TEST(NearMisses, KeepTheNarrowestOfMany) {
  NearMisses misses = OfTwo();
  for (std::size_t i = 0; i < NearMisses::kMostKept + 10; ++i) {
    const auto number = static_cast<double>(i);
    At(number, 0.1 - number * 1e-4, &misses);
    At(number + 0.5, 1.0, &misses);
  }
  EXPECT_THAT(misses.Narrowest(), SizeIs(NearMisses::kMostKept));
  EXPECT_LT(misses.Narrowest().front().distance_m, 0.1 - 9e-4 + 1e-9);
}

}  // namespace
}  // namespace giveway::fleetctl
