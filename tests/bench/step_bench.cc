// The cost of one step of the brain with 10, 100 and 1000 peers in the table, each received again
// every tick, as in a full mesh without loss: a fleet that drives along with the vehicle, to one
// side of it or all around it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "services/types/math/math.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

Beacon PeerAt(std::uint32_t i, Vec2 offset) {
  const Pose pose{.position_world = offset, .heading_rad = WrapAngle(0.7 * i)};
  Beacon beacon = test::BeaconOf(i + 2, 1, pose);
  if (i % 2 == 0) beacon.wheels = {3, 3};  // every other one drives
  return beacon;
}

// On a square grid of 2 m cells, one per 4 m^2, 10 m and more to the right of the vehicle's path.
std::vector<Beacon> PeersBeside(std::uint32_t count) {
  std::vector<Beacon> peers;
  for (std::uint32_t i = 0; i < count; ++i) {
    peers.push_back(PeerAt(i, {2.0 * (i % 32) + 2, 2.0 * (i / 32) - 16}));
  }
  return peers;
}

// The nearest of a grid of 2 m cells that the vehicle itself stands on.
std::vector<Beacon> PeersAround(std::uint32_t count) {
  std::vector<Vec2> places;
  for (int x = -20; x <= 20; ++x) {
    for (int y = -20; y <= 20; ++y) {
      if (x != 0 || y != 0) places.push_back({2.0 * x, 2.0 * y});
    }
  }
  std::ranges::stable_sort(places, {}, SquaredNorm);
  std::vector<Beacon> peers;
  for (std::uint32_t i = 0; i < count; ++i) peers.push_back(PeerAt(i, places[i]));
  return peers;
}

// The vehicle's wheels do what it commands, and the whole fleet moves on as it does.
void Drive(benchmark::State& bench, const std::vector<Beacon>& peers) {
  VehicleOptions options = test::DefaultOptions();
  options.emission_radius_m = 1000;  // every peer is received: the worst case
  options.goal.at_world = {90'000, 0};
  Vehicle vehicle(options, 42);
  std::vector<ReceivedBeacon> heard;
  for (const Beacon& peer : peers) heard.push_back(test::Received(peer, {}));
  std::uint32_t tick = 1;
  Inputs inputs;
  inputs.scan = test::ClearScan(tick);
  inputs.beacons = heard;
  Vec2 moved;
  for (auto _ : bench) {
    ++tick;
    inputs.now = tick * options.tick_period;
    inputs.scan->tick = Tick{tick};
    for (std::size_t i = 0; i < 8; ++i) inputs.scan->readings[i].tick = Tick{tick};
    for (std::size_t i = 0; i < heard.size(); ++i) {
      heard[i].beacon.tick = Tick{tick - 1};
      heard[i].beacon.seq = tick - 1;
      heard[i].beacon.world_from_body.position_world =
          peers[i].world_from_body.position_world + moved;
      heard[i].beacon.toward_world = peers[i].toward_world + moved;
      heard[i].received = inputs.now;
    }
    const Outputs outputs = vehicle.Step(inputs);
    inputs.scan->wheels = outputs.command.target;
    moved = outputs.beacon.world_from_body.position_world;
  }
}

std::uint32_t CountOf(const benchmark::State& bench) {
  return static_cast<std::uint32_t>(bench.range(0));
}

void VehicleStep(benchmark::State& bench) { Drive(bench, PeersBeside(CountOf(bench))); }
BENCHMARK(VehicleStep)->Arg(0)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void VehicleStepInCrowd(benchmark::State& bench) { Drive(bench, PeersAround(CountOf(bench))); }
BENCHMARK(VehicleStepInCrowd)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace giveway
