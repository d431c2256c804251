// Which echoes belong to a peer's body: those from its position, on any sensor, in any direction.
#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "tests/support/onlooker.h"

namespace giveway {
namespace {

// True if an echo is assigned to the body of a peer with its centre there.
bool IsOfBody(test::Onlooker* onlooker, std::size_t sensor, double range_m, Vec2 centre) {
  onlooker->Hear(sensor, range_m);
  Peer peer = test::PeerAt({centre, 0});
  return onlooker->RelatePeer(&peer).explains != 0;
}

struct Placed {
  std::size_t sensor;
  double off_rad;     // of the centre from the cone's axis, either way
  double distance_m;  // of the centre from the sensor
  Vec2 centre;
};

Placed Anywhere(const RobotModel& profile, Random* random) {
  Placed placed;
  placed.sensor = random->Next() % kSensorCount;
  placed.off_rad = random->Uniform(0, kPi);
  placed.distance_m = random->Uniform(0.3, 5);
  const SensorMount& mount = profile.sonar[placed.sensor];
  const double side = random->Uniform(0, 1) < 0.5 ? 1 : -1;
  const double bearing_rad = mount.bearing_rad + side * placed.off_rad;
  placed.centre =
      mount.position_body + placed.distance_m * Vec2{std::cos(bearing_rad), std::sin(bearing_rad)};
  return placed;
}

// Up to where the cone's edge meets what half the body shows more than it does. An echo so far
// behind the body's nearest point that it may be of any of it.
TEST(Echoes, AreOfABodyWhereItIsAndOfNoneElsewhere) {
  test::Onlooker onlooker;
  const RobotModel profile = test::DefaultOptions().profile;
  const double radius_m = test::BeaconOf(2, 1, {}).body_radius_m;
  Random random(5);
  int explained = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Placed placed = Anywhere(profile, &random);
    const double shows_rad =
        placed.distance_m > 1.5 * radius_m ? 1.5 * radius_m / placed.distance_m : kPi;
    const bool shows = placed.off_rad <= profile.sonar_half_angle_rad + shows_rad;
    const double nearest_m = placed.distance_m - radius_m;
    const auto is_its = [&](double behind_m) {
      return IsOfBody(&onlooker, placed.sensor, nearest_m + behind_m, placed.centre);
    };
    ASSERT_EQ(is_its(random.Uniform(0.2, 0.2499)), shows) << i << " off " << placed.off_rad;
    ASSERT_FALSE(is_its(0.2501)) << i;
    explained += shows ? 1 : 0;
  }
  EXPECT_GT(explained, 3000);
}

TEST(Echoes, BeforeTheBodyByMoreThanIsUnsureAreNotOfIt) {
  test::Onlooker onlooker;
  const RobotModel profile = test::DefaultOptions().profile;
  const double radius_m = test::BeaconOf(2, 1, {}).body_radius_m;
  Random random(6);
  for (int i = 0; i < 5000; ++i) {
    const Placed placed = Anywhere(profile, &random);
    if (placed.off_rad > profile.sonar_half_angle_rad || placed.distance_m < 0.4) continue;
    const double nearest_m = placed.distance_m - radius_m;
    ASSERT_TRUE(IsOfBody(&onlooker, placed.sensor, nearest_m - 0.059, placed.centre)) << i;
    ASSERT_FALSE(IsOfBody(&onlooker, placed.sensor, nearest_m - 0.061, placed.centre)) << i;
  }
}

}  // namespace
}  // namespace giveway
