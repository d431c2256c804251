// Priority inheritance: the key of the first of the vehicles that this one blocks.
#include "services/vehicle/situation/blocked.h"

#include <gtest/gtest.h>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

constexpr VehicleId kOwn{1};
constexpr PriorityKey kOwnKey{.speed_bucket = 6, .vehicle = kOwn};

// The acting priority of a vehicle that has received these beacons.
PriorityKey After(const std::vector<Beacon>& beacons) {
  PeerTable peers;
  BeaconCounters counters;
  TrustCounters trust;
  for (const Beacon& beacon : beacons) {
    peers.Take(test::Received(beacon, {}), {kOwn, test::kEpoch, Tick{9}, {}},
               test::DefaultOptions(), &counters, &trust);
  }
  EXPECT_EQ(counters.taken, counters.accepted + counters.not_heard);
  return ActingOrder(kOwnKey, peers, kOwn);
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

}  // namespace
}  // namespace giveway
