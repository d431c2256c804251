// What one step of the brain costs with 10, 100 and 1000 peers in the table, each heard anew every
// tick, as in a full mesh without loss.
#include <benchmark/benchmark.h>

#include <vector>

#include "services/types/math.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

// Peers on a square grid of 2 m cells, one per 4 m^2, every other one driving.
std::vector<ReceivedBeacon> Peers(std::uint32_t count) {
  std::vector<ReceivedBeacon> peers;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Pose pose{.position_world = {2.0 * (i % 32) + 2, 2.0 * (i / 32) - 16},
                    .heading_rad = WrapAngle(0.7 * i)};
    Beacon beacon = test::BeaconOf(i + 2, 1, pose);
    if (i % 2 == 0) beacon.wheels = {3, 3};
    peers.push_back(test::Received(beacon, {}));
  }
  return peers;
}

void VehicleStep(benchmark::State& bench) {
  VehicleOptions options = test::DefaultOptions();
  options.emission_radius_m = 1000;  // everyone is heard: the worst case
  Vehicle vehicle(options, 42);
  std::vector<ReceivedBeacon> peers = Peers(static_cast<std::uint32_t>(bench.range(0)));
  std::uint32_t tick = 1;
  for (auto _ : bench) {
    ++tick;
    Inputs inputs;
    inputs.now = tick * options.tick_period;
    inputs.scan = test::ClearScan(tick);
    for (ReceivedBeacon& peer : peers) {
      peer.beacon.tick = Tick{tick - 1};
      peer.beacon.seq = tick - 1;
      peer.received = inputs.now;
    }
    inputs.beacons = peers;
    benchmark::DoNotOptimize(vehicle.Step(inputs));
  }
}
BENCHMARK(VehicleStep)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace giveway
