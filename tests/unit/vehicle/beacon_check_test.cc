// Every number of a beacon has a minimum and a maximum, and both are in range.
#include "services/vehicle/estimation/beacon_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/types/fleet_limits.h"
#include "services/types/math/math.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTiniest = std::numeric_limits<double>::denorm_min();

constexpr double kTurnSquared_rad2 = 4 * kPi * kPi;

struct Bounds {
  const char* name;
  double& (*number)(Beacon&);
  double least;
  double most;
};

// A beacon whose cruise speed is consistent with its priority key.
Beacon Believable() {
  Beacon beacon = test::BeaconOf(2, 1, {});
  beacon.order.vehicle = VehicleId{9};
  return beacon;
}

const Bounds kBounds[] = {
    {"wheels.left", [](Beacon& b) -> double& { return b.wheels.left_rad_s; }, -kMaxWheel_rad_s,
     kMaxWheel_rad_s},
    {"wheels.right", [](Beacon& b) -> double& { return b.wheels.right_rad_s; }, -kMaxWheel_rad_s,
     kMaxWheel_rad_s},
    {"cruise", [](Beacon& b) -> double& { return b.cruise_m_s; }, 0, kMaxSpeed_m_s},
    {"x", [](Beacon& b) -> double& { return b.world_from_body.position_world.x; }, -1e5, 1e5},
    {"y", [](Beacon& b) -> double& { return b.world_from_body.position_world.y; }, -1e5, 1e5},
    {"heading", [](Beacon& b) -> double& { return b.world_from_body.heading_rad; }, -kPi - 1e-9,
     kPi + 1e-9},
    {"xx", [](Beacon& b) -> double& { return b.covariance.xx_m2; }, 0, 1e6},
    {"xy", [](Beacon& b) -> double& { return b.covariance.xy_m2; }, -1e6, 1e6},
    {"yy", [](Beacon& b) -> double& { return b.covariance.yy_m2; }, 0, 1e6},
    {"xh", [](Beacon& b) -> double& { return b.covariance.xh_m_rad; }, -2000 * kPi, 2000 * kPi},
    {"yh", [](Beacon& b) -> double& { return b.covariance.yh_m_rad; }, -2000 * kPi, 2000 * kPi},
    {"hh", [](Beacon& b) -> double& { return b.covariance.hh_rad2; }, 0, kTurnSquared_rad2},
    {"radius", [](Beacon& b) -> double& { return b.body_radius_m; }, 0.01, 20},
    {"wheel radius", [](Beacon& b) -> double& { return b.drive.wheel_radius_m; }, 0.01, 20},
    {"axle", [](Beacon& b) -> double& { return b.drive.axle_m; }, 0.01, 20},
    {"acceleration", [](Beacon& b) -> double& { return b.acceleration_m_s2; }, kTiniest, 20},
    {"deceleration", [](Beacon& b) -> double& { return b.deceleration_m_s2; }, kTiniest, 20},
    {"toward x", [](Beacon& b) -> double& { return b.toward_world.x; }, -1e5, 1e5},
    {"toward y", [](Beacon& b) -> double& { return b.toward_world.y; }, -1e5, 1e5},
};

bool IsInRangeWith(const Bounds& bounds, double value) {
  Beacon beacon = Believable();
  bounds.number(beacon) = value;
  // A completely unknown position: no covariance is too large for it.
  PoseCovariance& c = beacon.covariance;
  if (c.xy_m2 != 0) c.xx_m2 = c.yy_m2 = 1e6;
  return IsInRange(beacon);
}

TEST(BeaconCheck, EveryNumberIsInRangeUpToItsBoundsAndNoFarther) {
  ASSERT_TRUE(IsInRange(Believable()));
  for (const Bounds& bounds : kBounds) {
    EXPECT_TRUE(IsInRangeWith(bounds, bounds.least)) << bounds.name;
    EXPECT_TRUE(IsInRangeWith(bounds, bounds.most)) << bounds.name;
    EXPECT_FALSE(IsInRangeWith(bounds, std::nextafter(bounds.least, -kInfinity))) << bounds.name;
    EXPECT_FALSE(IsInRangeWith(bounds, std::nextafter(bounds.most, kInfinity))) << bounds.name;
    EXPECT_FALSE(IsInRangeWith(bounds, std::numeric_limits<double>::quiet_NaN())) << bounds.name;
  }
}

TEST(BeaconCheck, ANumberIsInRangeIfAndOnlyIfItIsBetweenItsBounds) {
  for (const Bounds& bounds : kBounds) {
    for (const double factor : {-kInfinity, -1e200, -2.0, -1.001, -0.999, -0.5, -1e-200, 1e-200,
                                0.5, 0.999, 1.001, 2.0, 1e200, kInfinity}) {
      const double value = factor * bounds.most;
      EXPECT_EQ(IsInRangeWith(bounds, value), value >= bounds.least && value <= bounds.most)
          << bounds.name << ' ' << value;
    }
  }
}

// A number that may be 0 may be -0: a value rounded to zero keeps its sign.
TEST(BeaconCheck, AZeroWithASignIsAZero) {
  for (const Bounds& bounds : kBounds) {
    if (bounds.least > 0) continue;
    EXPECT_TRUE(IsInRangeWith(bounds, -0.0)) << bounds.name;
  }
}

TEST(BeaconCheck, NoCovarianceIsGreaterThanTheMeanOfItsVariances) {
  Beacon beacon = Believable();
  beacon.covariance.xx_m2 = 1;
  beacon.covariance.yy_m2 = 3;
  for (const double sign : {-1, 1}) {
    beacon.covariance.xy_m2 = sign * 2;
    EXPECT_TRUE(IsInRange(beacon));
    beacon.covariance.xy_m2 = sign * 2.001;
    EXPECT_FALSE(IsInRange(beacon));
  }
}

}  // namespace
}  // namespace giveway
