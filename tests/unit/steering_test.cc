#include "services/vehicle/steering.h"

#include <gtest/gtest.h>

#include "services/types/math.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

RangeView Seeing(int sensor, double range_m) {
  RangeScan scan = test::ClearScan(1);
  test::SetEcho(&scan, sensor, range_m);
  RangeView view;
  view.Take(scan, milliseconds(50), milliseconds(50));
  return view;
}

TEST(Steering, ActivationIsOneAtTheNearGateAndNothingAtTheFarOne) {
  const BraitenbergWeights lecture = LectureWeights();
  EXPECT_EQ(Avoid(lecture, Seeing(1, 1.0)).wheels, (WheelSpeeds{2, 2}));
  EXPECT_NEAR(Avoid(lecture, Seeing(1, 0.6)).wheels.left_rad_s, 2.5, 1e-12);
  EXPECT_NEAR(Avoid(lecture, Seeing(1, 0.2)).wheels.left_rad_s, 3, 1e-12);
  EXPECT_NEAR(Avoid(lecture, Seeing(1, 0.05)).wheels.left_rad_s, 3, 1e-12);
}

TEST(Steering, TheLecturesVehicleTurnsAwayFromEitherSide) {
  const BraitenbergWeights lecture = LectureWeights();
  const WheelSpeeds left = Avoid(lecture, Seeing(1, 0.4)).wheels;
  const WheelSpeeds right = Avoid(lecture, Seeing(6, 0.4)).wheels;
  EXPECT_GT(left.left_rad_s, left.right_rad_s);  // object on the left: turns right
  EXPECT_EQ(left.left_rad_s, right.right_rad_s);
  EXPECT_EQ(left.right_rad_s, right.left_rad_s);
}

// The stock script's table for base 2 rad/s: sensor 4 alone gives 1.2 and 1.0.
TEST(Steering, TheStockVehicleBrakesAndTurnsAway) {
  const WheelSpeeds wheels = Avoid(StockWeights(), Seeing(3, 0.1)).wheels;
  EXPECT_NEAR(wheels.left_rad_s, 1.2, 1e-12);
  EXPECT_NEAR(wheels.right_rad_s, 1.0, 1e-12);
}

TEST(Steering, ALargeErrorTurnsOnTheSpotFirst) {
  const VehicleProfile p3dx = PioneerP3dx();
  const WheelSpeeds wheels = Drive(p3dx, {}, {.heading_error_rad = 0.5}, 0.3, true);
  EXPECT_NEAR(wheels.left_rad_s, -wheels.right_rad_s, 1e-12);
  EXPECT_GT(wheels.right_rad_s, 0);
}

TEST(Steering, ADeadStopDoesNotTurn) {
  EXPECT_EQ(Drive(PioneerP3dx(), {}, {.heading_error_rad = 0.5}, 0, false), WheelSpeeds{});
}

}  // namespace
}  // namespace giveway
