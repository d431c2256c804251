// What distrust takes away from a peer's statements, and that it never makes a vehicle less
// careful.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "services/types/math/random.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;

// The own vehicle has priority, at 0.3 m/s; the conflict starts at x = 3.4. A peer to the south of
// it grants, and may have jumped shortly before.
Outputs DriveUpToAGrant(bool jumps) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  RangeScan scan = ClearScan(0);
  scan.wheels = {0.3 / 0.0975, 0.3 / 0.0975};
  Outputs out = bench.Step(scan);
  for (int i = 1; i < 400; ++i) {
    const bool jumped = jumps && i == 190;
    Beacon beacon =
        BeaconOf(2, bench.NextTick() - 1,
                 {.position_world = {4, jumped ? -2.2 : -1.2}, .heading_rad = kPi / 2}, 0.2);
    beacon.gives_way_to = VehicleId{1};
    out = bench.Step(scan, {beacon});
    if (out.command.target == WheelSpeeds{}) break;
  }
  return out;
}

TEST(Doubt, AGrantIsNotBelieved) {
  EXPECT_NE(DriveUpToAGrant(false).command.decision.rule, Rule::kNotGranted);
  const Outputs out = DriveUpToAGrant(true);
  EXPECT_EQ(out.command.decision.rule, Rule::kNotGranted);
  EXPECT_LT(out.beacon.world_from_body.position_world.x, 3.4 - 0.075);
}

// Random inputs of a few ticks, by number.
Inputs AnyInputs(Random* random, std::uint32_t tick, std::vector<ReceivedBeacon>* heard) {
  Inputs inputs;
  inputs.now = tick * Nanoseconds(50'000'000);
  RangeScan scan = ClearScan(tick);
  for (int i = 0; i < 8; ++i) {
    if (random->Uniform(0, 1) < 0.4) test::SetEcho(&scan, i, random->Uniform(0.2, 4));
    if (random->Uniform(0, 1) < 0.01) scan.readings[static_cast<std::size_t>(i)] = {};
  }
  scan.wheels = {random->Uniform(0, 4), random->Uniform(0, 4)};
  inputs.scan = scan;
  heard->clear();
  for (std::uint32_t id = 2; id < 6 && tick > 1; ++id) {
    Beacon beacon = BeaconOf(id, tick - 1,
                             {.position_world = {random->Uniform(-3, 3), random->Uniform(-3, 3)},
                              .heading_rad = random->Uniform(-3, 3)},
                             random->Uniform(0.1, 0.9));
    if (random->Uniform(0, 1) < 0.5) beacon.wheels = {3, 3};
    if (random->Uniform(0, 1) < 0.3) beacon.rule = Rule::kSignal;
    if (random->Uniform(0, 1) < 0.3) beacon.gives_way_to = VehicleId{1};
    if (random->Uniform(0, 1) < 0.9) heard->push_back(test::Received(beacon, inputs.now));
  }
  inputs.beacons = *heard;
  inputs.leaving = random->Uniform(0, 1) < 0.05;
  return inputs;
}

// The ladder of decision.h, from the top.
int RungOf(const Outputs& out) { return static_cast<int>(out.command.decision.mode); }

TEST(Doubt, NeverRaisesTheMode) {
  const auto believing = std::make_unique<VehicleState>();
  const auto doubting = std::make_unique<VehicleState>();
  int lowered = 0;
  for (std::uint32_t number = 1; number <= 2000; ++number) {
    Random random(number);
    Vehicle vehicle(test::DefaultOptions(), 42);
    std::vector<ReceivedBeacon> heard;
    const std::uint32_t ticks = 2 + number % 8;
    for (std::uint32_t tick = 1; tick < ticks; ++tick) {
      vehicle.Step(AnyInputs(&random, tick, &heard));
    }
    const Inputs last = AnyInputs(&random, ticks, &heard);
    *believing = vehicle.State();
    for (Peer& peer : believing->heard.peers.Peers()) peer.trust = {};
    *doubting = *believing;
    for (Peer& peer : doubting->heard.peers.Peers()) {
      peer.trust = {.ever_doubted = true, .doubted_at = last.now};
    }
    // The last step is repeated without the beacons, which hold the jumps.
    Inputs without_jumps = last;
    without_jumps.beacons = {};
    vehicle.Restore(*believing);
    const Outputs believed = vehicle.Step(without_jumps);
    vehicle.Restore(*doubting);
    const Outputs doubted = vehicle.Step(without_jumps);
    EXPECT_GE(RungOf(doubted), RungOf(believed)) << number;
    lowered += RungOf(doubted) > RungOf(believed) ? 1 : 0;
  }
  EXPECT_GT(lowered, 100);
}

}  // namespace
}  // namespace giveway
