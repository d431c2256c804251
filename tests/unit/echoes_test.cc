// Which echoes are a peer's body: those from where it is, of any sensor, in any direction.
#include "services/vehicle/echoes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math.h"
#include "services/types/random.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

// A vehicle at the origin that looks east, one of whose sensors hears something.
class Listener {
 public:
  // The sensors that a peer with its centre there explains the echo of.
  std::uint32_t Explained(std::size_t sensor, double range_m, Vec2 centre) {
    RangeScan scan = test::ClearScan(2);
    test::SetEcho(&scan, static_cast<int>(sensor), range_m);
    RangeView ranges;
    ranges.Take(scan, SteadyTime{0}, options_.tick_period);
    HeardEchoes echoes{};
    HearEchoes(ranges, Tick{2}, options_, &echoes);
    const SeenObjects objects;
    Situation s{.options = options_,
                .ranges = ranges,
                .echoes = echoes,
                .cones = cones_,
                .objects = objects};
    s.tick = Tick{2};
    s.forward_world = {1, 0};
    Peer peer{.id = VehicleId{2}, .known = true};
    peer.beacon = test::BeaconOf(2, 1, {centre, 0});
    PeerView view{.peer = &peer, .fresh = true};
    view.position_world = centre;
    return EchoesOf(view, s);
  }

  const VehicleProfile& Profile() const { return options_.profile; }

 private:
  VehicleOptions options_ = test::DefaultOptions();
  Cones cones_ = ConesOf(options_.profile);
};

struct Placed {
  std::size_t sensor;
  double off_rad;     // of the centre from the cone's axis, either way
  double distance_m;  // of the centre from the sensor
  Vec2 centre;
};

Placed Anywhere(const VehicleProfile& profile, Random* random) {
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
  Listener listener;
  const double radius_m = test::BeaconOf(2, 1, {}).body_radius_m;
  Random random(5);
  int explained = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Placed placed = Anywhere(listener.Profile(), &random);
    const double shows_rad =
        placed.distance_m > 1.5 * radius_m ? 1.5 * radius_m / placed.distance_m : kPi;
    const bool shows = placed.off_rad <= listener.Profile().sonar_half_angle_rad + shows_rad;
    const double nearest_m = placed.distance_m - radius_m;
    const auto is_its = [&](double behind_m) {
      return listener.Explained(placed.sensor, nearest_m + behind_m, placed.centre) != 0;
    };
    ASSERT_EQ(is_its(random.Uniform(0.2, 0.2499)), shows) << i << " off " << placed.off_rad;
    ASSERT_FALSE(is_its(0.2501)) << i;
    explained += shows ? 1 : 0;
  }
  EXPECT_GT(explained, 3000);
}

TEST(Echoes, BeforeTheBodyByMoreThanIsUnsureAreNotOfIt) {
  Listener listener;
  const double radius_m = test::BeaconOf(2, 1, {}).body_radius_m;
  Random random(6);
  for (int i = 0; i < 5000; ++i) {
    const Placed placed = Anywhere(listener.Profile(), &random);
    if (placed.off_rad > listener.Profile().sonar_half_angle_rad || placed.distance_m < 0.4)
      continue;
    const double nearest_m = placed.distance_m - radius_m;
    ASSERT_NE(listener.Explained(placed.sensor, nearest_m - 0.059, placed.centre), 0U) << i;
    ASSERT_EQ(listener.Explained(placed.sensor, nearest_m - 0.061, placed.centre), 0U) << i;
  }
}

}  // namespace
}  // namespace giveway
