// Priority inheritance: the key of the first of the vehicles that this one blocks.
#include "services/vehicle/situation/blocked.h"

#include <gtest/gtest.h>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

constexpr VehicleId kOwn{1};
constexpr PriorityKey kOwnKey{.speed_bucket = 6, .vehicle = kOwn};

// The acting priority of a vehicle that has received these beacons, so many ticks later.
PriorityKey After(const std::vector<Beacon>& beacons, std::uint32_t ticks = 0) {
  PeerTable peers;
  BeaconCounters counters;
  TrustCounters trust;
  for (const Beacon& beacon : beacons) {
    peers.Take(test::Received(beacon, {}), {kOwn, test::kEpoch, Tick{9}, {}},
               test::DefaultOptions(), &counters, &trust);
  }
  EXPECT_EQ(counters.taken, counters.accepted + counters.not_heard);
  const VehicleOptions options = test::DefaultOptions();
  const Moment moment{.now = ticks * options.tick_period, .tick = Tick{9 + ticks}};
  return ActingOrder(kOwnKey, peers, moment, options);
}

// Faster than this vehicle, and blocked by it.
Beacon HeldUp(std::uint32_t tick) {
  Beacon beacon = test::BeaconOf(2, tick, {.position_world = {-1, 0}}, 0.4);
  beacon.blocked_by = kOwn;
  return beacon;
}

TEST(ActingOrder, IsLentByOneThatThisVehicleIsInTheWayOf) {
  EXPECT_EQ(After({HeldUp(1)}), HeldUp(1).order);
}

TEST(ActingOrder, IsTheOwnWhereAnotherOneIsInTheWayOrTheOneHeldUpComesLater) {
  Beacon beacon = HeldUp(1);
  beacon.blocked_by = VehicleId{3};
  EXPECT_EQ(After({beacon}), kOwnKey);
  EXPECT_EQ(After({test::BeaconOf(2, 1, {.position_world = {-1, 0}}, 0.2)}), kOwnKey);
}

TEST(ActingOrder, IsTheOwnAgainOnceTheOneThatLentItIsGone) {
  Beacon good_bye = HeldUp(2);
  good_bye.mode = Mode::kLeaving;
  EXPECT_EQ(After({HeldUp(1), good_bye}), kOwnKey);
  Beacon far = HeldUp(2);
  far.world_from_body.position_world.x = -2 * test::DefaultOptions().emission_radius_m;
  EXPECT_EQ(After({HeldUp(1), far}), kOwnKey);
}

// By the key of a vehicle that had died behind it, one acted for half a minute.
TEST(ActingOrder, IsTheOwnAgainOnceTheOneThatLentItHasBeenSilentForLong) {
  EXPECT_EQ(After({HeldUp(8)}, 20), HeldUp(8).order);
  EXPECT_EQ(After({HeldUp(8)}, 21), kOwnKey);
}

TEST(ActingOrder, IsTheOwnWhereTheOneHeldUpIsDoubted) {
  Beacon jumped = HeldUp(2);
  jumped.world_from_body.position_world.x = -3;
  EXPECT_EQ(After({HeldUp(1), jumped}), kOwnKey);
  EXPECT_EQ(After({HeldUp(1), HeldUp(2)}), HeldUp(2).order);
}

// Regression: one that waited before a crossing by the key of the one behind it lost that key every
// second, for the other gave way to it then and was blocked by none; meanwhile the two in front
// waited for each other.
TEST(BlockedBy, LastsAsLongAsTheInheritedKeyIsWhatItHoldsFor) {
  test::BrainBench bench(test::OptionsWithoutUltrasonics());
  // Stands ahead in the lane, and later, by the own key, across it.
  const auto beacon_at = [](std::uint32_t tick, double heading_rad) {
    Beacon beacon =
        test::BeaconOf(2, tick, {.position_world = {1.2, 0}, .heading_rad = heading_rad}, 0.2);
    beacon.rule = Rule::kGiveWay;
    if (heading_rad != 0) beacon.order = {.speed_bucket = 6, .vehicle = kOwn};
    return beacon;
  };
  Outputs out;
  for (int i = 0; i < 100; ++i) {
    const std::uint32_t heard = bench.NextTick() - 1;
    std::vector<Beacon> beacons;
    if (heard > 0) beacons = {beacon_at(heard, heard < 20 ? 0 : 0.6)};
    out = bench.Step(test::ClearScan(0), beacons);
    if (heard <= 1) continue;
    ASSERT_EQ(out.beacon.blocked_by, VehicleId{2}) << heard;
  }
  EXPECT_EQ(out.command.decision.rule, Rule::kGiveWay);
}

}  // namespace
}  // namespace giveway
