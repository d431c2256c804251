// A refused beacon is reported with the field, its value and the allowed range.
#include "services/vehicle/refused_beacon.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <memory>

#include "services/types/math/random.h"
#include "services/vehicle/estimation/beacon_check.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string FaultText(const Beacon& beacon) {
  const auto fault = FaultOf(beacon);
  return fault ? Describe(*fault) : "";
}

TEST(RefusedBeacon, IsToldWithFieldValueAndBound) {
  Beacon beacon = test::BeaconOf(2, 1, {});
  EXPECT_EQ(FaultText(beacon), "");
  beacon.cruise_m_s = 7;
  EXPECT_EQ(FaultText(beacon), "cruise_m_s is 7, must be 0 to 2.5");
  beacon.cruise_m_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FaultText(beacon), "cruise_m_s is nan, must be 0 to 2.5");
  beacon = test::BeaconOf(2, 1, {});
  beacon.boot_epoch = 0;
  EXPECT_EQ(FaultText(beacon), "boot_epoch is 0, must be 1 to 4294967295");
  beacon = test::BeaconOf(2, 1, {});
  beacon.covariance.xy_m2 = 3;
  EXPECT_THAT(FaultText(beacon), StartsWith("covariance.xy_m2 is 3, must be -"));
  beacon = test::BeaconOf(2, 1, {});
  beacon.order.waited_ticks = 2;
  EXPECT_EQ(FaultText(beacon), "order_waited_ticks is 2, must be 0 to 1");
}

// 0.3 / 0.05 is just less than 6: truncated instead of rounded it is 5, and the vehicle was never
// heard.
TEST(RefusedBeacon, WithASpeedBucketThatWasCutIsToldTheRoundedOne) {
  Beacon beacon = test::BeaconOf(2, 1, {});
  beacon.cruise_m_s = 0.3;
  beacon.order = {0, static_cast<std::uint32_t>(std::floor(0.29999 / 0.05)), VehicleId{2}};
  EXPECT_EQ(FaultText(beacon), "order_speed_bucket is 5, must be 6");
}

TEST(RefusedBeacon, HasAFaultIfAndOnlyIfItIsOutOfRange) {
  Random random(7);
  const double values[] = {0,
                           -1,
                           0.005,
                           0.3,
                           5,
                           25,
                           -31,
                           1e6,
                           1e-9,
                           std::nan(""),
                           std::numeric_limits<double>::infinity()};
  double Beacon::*const numbers[] = {&Beacon::cruise_m_s, &Beacon::body_radius_m,
                                     &Beacon::acceleration_m_s2, &Beacon::deceleration_m_s2};
  int refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    Beacon beacon = test::BeaconOf(static_cast<std::uint32_t>(random.Next() % 3), 4, {});
    beacon.*numbers[random.Next() % 4] = values[random.Next() % 11];
    beacon.world_from_body.position_world.x = values[random.Next() % 11];
    beacon.covariance.xy_m2 = values[random.Next() % 5];
    beacon.covariance.xx_m2 = values[random.Next() % 11];
    beacon.wheels.left_rad_s = values[random.Next() % 11];
    beacon.order = {static_cast<std::uint32_t>(random.Next() % 6),
                    static_cast<std::uint32_t>(random.Next() % 60),
                    VehicleId{static_cast<std::uint32_t>(random.Next() % 3)}};
    if (random.Next() % 3 == 0) beacon = test::BeaconOf(2, 4, {});
    if (random.Next() % 9 == 0) beacon.seq = 0;
    refused += IsInRange(beacon) ? 0 : 1;
    ASSERT_EQ(IsInRange(beacon), !FaultOf(beacon).has_value()) << FaultText(beacon);
  }
  EXPECT_GT(refused, 5'000);
}

TEST(RefusedBeacon, OfAStepIsExplained) {
  const auto bench_options = test::DefaultOptions();
  Vehicle vehicle(bench_options, 9);
  const auto state = std::make_unique<VehicleState>(vehicle.State());
  state->world.epoch = test::kEpoch;
  Beacon beacon = test::BeaconOf(5, 3, {});
  beacon.cruise_m_s = 3;
  const ReceivedBeacon received = test::Received(beacon, SteadyTime{0});
  EXPECT_EQ(Describe(Explain(received, BeaconRefusal::kOutOfRange, *state)),
            "refuses a beacon of vehicle 5: cruise_m_s is 3, must be 0 to 2.5 "
            "(rejected_out_of_range)");
  beacon = test::BeaconOf(5, 1000, {});
  state->world.tick = Tick{900};
  const Refusal ahead =
      Explain(test::Received(beacon, SteadyTime{0}), BeaconRefusal::kOutOfRange, *state);
  EXPECT_EQ(ahead.why, "tick is 1000, must be 0 to 920");
  EXPECT_TRUE(ahead.passing);
  beacon.world_epoch = WorldEpoch{77};
  const Refusal elsewhere =
      Explain(test::Received(beacon, SteadyTime{0}), BeaconRefusal::kWrongEpoch, *state);
  EXPECT_THAT(elsewhere.why, HasSubstr("world_epoch is 77, must be "));
  EXPECT_TRUE(elsewhere.passing);
}

TEST(RefusedBeacon, IsNamedByTheStepThatRefusedIt) {
  VehicleOptions options = test::DefaultOptions();
  Vehicle vehicle(options, 9);
  std::vector<ReceivedBeacon> beacons;
  for (std::uint32_t i = 0; i < 12; ++i) {
    Beacon beacon = test::BeaconOf(5 + i, 3, {});
    if (i > 0) beacon.cruise_m_s = 3;
    beacons.push_back(test::Received(beacon, SteadyTime{0}));
  }
  Inputs inputs;
  inputs.beacons = beacons;
  vehicle.Step(inputs);
  EXPECT_EQ(vehicle.State().counters.beacons.rejected_out_of_range, 11U);
  ASSERT_EQ(vehicle.Refused().size(), 8U);  // of more only the first: the counter has all
  EXPECT_EQ(vehicle.Refused()[0].index, 1U);
  EXPECT_EQ(vehicle.Refused()[0].why, BeaconRefusal::kOutOfRange);
  vehicle.Step({});
  EXPECT_TRUE(vehicle.Refused().empty());
}

}  // namespace
}  // namespace giveway
