// How waiting raises a vehicle's priority: one brain on the bench, heading east at 0.3 m/s. Faster
// peers, which have priority, cross its path 4 m ahead, one behind the other. An ageing limit is
// ten ticks.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;

constexpr std::uint32_t kLimit_ticks = 10;

class Waiting {
 public:
  Waiting() : bench_(Options()) {}

  // The wheels do as commanded. The beacons of `peers` are of the tick before.
  void Step(std::vector<Beacon> peers) {
    for (Beacon& peer : peers) peer.tick = Tick{peer.seq = bench_.NextTick() - 1};
    RangeScan scan = ClearScan(0);
    scan.wheels = out_.command.target;
    out_ = bench_.Step(scan, bench_.NextTick() == 1 ? std::vector<Beacon>{} : peers);
  }
  void Steps(std::uint32_t count, const std::vector<Beacon>& peers) {
    for (std::uint32_t i = 0; i < count; ++i) Step(peers);
  }
  void StepBlind() { out_ = bench_.StepBlind(); }
  // Drives up to where it waits for the peers, until its wait starts.
  void DriveUpTo(const std::vector<Beacon>& peers) {
    for (int i = 0; i < 600 && WaitedTicks() == 0; ++i) Step(peers);
    ASSERT_EQ(WaitedTicks(), 1U);
  }

  // True if an encounter with that peer is active.
  bool Meets(std::uint32_t id) const {
    const auto peers = bench_.Brain().State().heard.peers.Peers();
    return std::ranges::any_of(peers, [id](const Peer& peer) {
      return peer.id == VehicleId{id} && peer.encounter.active;
    });
  }
  std::uint32_t WaitedTicks() const { return bench_.Brain().State().waiting.waited_ticks; }
  std::uint32_t PlaceInOrder() const { return out_.beacon.order.waited_ticks; }
  double X() const { return out_.beacon.world_from_body.position_world.x; }

 private:
  static VehicleOptions Options() {
    VehicleOptions options = test::OptionsWithoutUltrasonics();
    options.ageing_limit = kLimit_ticks * options.tick_period;
    return options;
  }

  BrainBench bench_;
  Outputs out_;
};

// Creeps towards the own path, so that it counts as a path and not as a body.
Beacon Coming(std::uint32_t id) {
  Beacon beacon = BeaconOf(id, 1, {.position_world = {4, -1.5}, .heading_rad = kPi / 2}, 0.4);
  beacon.wheels = {0.2, 0.2};
  return beacon;
}
Beacon Gone(std::uint32_t id) {
  return BeaconOf(id, 1, {.position_world = {4, 3}, .heading_rad = kPi / 2}, 0.4);
}

TEST(KeepOrder, ThePlaceStandsWhileTheFirstToBeMetIsThere) {
  Waiting vehicle;
  vehicle.DriveUpTo({Coming(2)});
  vehicle.Steps(3 * kLimit_ticks, {Coming(2)});
  EXPECT_GT(vehicle.WaitedTicks(), 2 * kLimit_ticks);
  EXPECT_EQ(vehicle.PlaceInOrder(), 0U);
}

TEST(KeepOrder, ItRisesByWholeLimitsOnceSomebodyHasPassedThoughTheNextIsThere) {
  Waiting vehicle;
  vehicle.DriveUpTo({Coming(2), Coming(3)});
  vehicle.Steps(kLimit_ticks / 2, {Coming(2), Coming(3)});
  std::uint32_t highest = 0;
  for (std::uint32_t i = 0; i < 3 * kLimit_ticks && vehicle.X() < 3.5; ++i) {
    vehicle.Step({Gone(2), Coming(3)});
    highest = std::max(highest, vehicle.PlaceInOrder());
    EXPECT_EQ(vehicle.PlaceInOrder() % kLimit_ticks, 0U);
  }
  EXPECT_GE(highest, kLimit_ticks);
}

TEST(KeepOrder, WhatItWaitedIsForgottenOnceItIsThrough) {
  Waiting vehicle;
  vehicle.DriveUpTo({Coming(2)});
  vehicle.Steps(2 * kLimit_ticks, {Coming(2)});
  vehicle.Steps(2, {Gone(2)});
  EXPECT_EQ(vehicle.PlaceInOrder(), 2 * kLimit_ticks);
  const double waited_m = vehicle.X();
  while (vehicle.X() < waited_m + 2.4) vehicle.Step({Gone(2)});
  EXPECT_EQ(vehicle.PlaceInOrder(), 2 * kLimit_ticks);
  while (vehicle.X() < waited_m + 2.6) vehicle.Step({Gone(2)});
  EXPECT_EQ(vehicle.PlaceInOrder(), 0U);
  EXPECT_EQ(vehicle.WaitedTicks(), 0U);
}

// The first is through before the vehicle has to wait for the second at all.
TEST(KeepOrder, WhoPassedBeforeItWaitedHasNotBeenLetPass) {
  Waiting vehicle;
  while (!vehicle.Meets(2)) vehicle.Step({Coming(2), Coming(3)});
  ASSERT_EQ(vehicle.WaitedTicks(), 0U);
  vehicle.DriveUpTo({Gone(2), Coming(3)});
  vehicle.Steps(3 * kLimit_ticks, {Gone(2), Coming(3)});
  EXPECT_GT(vehicle.WaitedTicks(), 2 * kLimit_ticks);
  EXPECT_EQ(vehicle.PlaceInOrder(), 0U);
}

// In a world at half speed steps come twice a tick: peers would reject a wait longer than the
// world's time.
TEST(KeepOrder, StepsWithoutANewTickAreNoWaiting) {
  Waiting vehicle;
  vehicle.DriveUpTo({Coming(2)});
  const std::uint32_t before = vehicle.WaitedTicks();
  for (int i = 0; i < 5; ++i) {
    vehicle.Step({Coming(2)});
    vehicle.StepBlind();
  }
  EXPECT_EQ(vehicle.WaitedTicks(), before + 5);
}

}  // namespace
}  // namespace giveway
