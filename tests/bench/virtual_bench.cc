// The cost of a vehicle and tick in virtual time: in total, and of the radio, the world and the
// invariants separately. Fifty vehicles on a lattice, each with about ten others in reach, or with
// all of them.
#include <benchmark/benchmark.h>

#include <vector>

#include "services/types/math/math.h"
#include "sim_world/virtual/virtual_fleet.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::sim {
namespace {

constexpr std::uint32_t kColumns = 10;
constexpr std::uint32_t kVehicles = 50;
constexpr double kSpacing_m = 2.6;  // eight to ten neighbours within 5 m

// Each off the lattice by its own few centimetres: of gaps that are all alike every one would be
// looked at as the closest of the run in every tick.
Vec2 Place(std::uint32_t i) {
  const Vec2 off = {0.002 * (7 * i % 19), 0.002 * (5 * i % 23)};
  return kSpacing_m * Vec2{1.0 * (i % kColumns), 1.0 * (i / kColumns)} + off;
}

// All vehicles drive north in lanes of their own for an hour, so that the neighbours stay the same.
Scenario Fleet(double emission_radius_m) {
  Scenario scenario;
  scenario.name = "bench";
  scenario.duration_s = 3600;
  for (std::uint32_t i = 0; i < kVehicles; ++i) {
    VehicleOptions options;
    options.id = VehicleId{i + 1};
    options.profile = PioneerP3dx();
    options.cruise_m_s = 0.3;
    options.emission_radius_m = emission_radius_m;
    options.start_world = {.position_world = Place(i), .heading_rad = kPi / 2};
    options.goal = {.set = true, .at_world = Place(i) + Vec2{0, 5000}};
    scenario.vehicles.push_back(options);
  }
  return scenario;
}

void CountVehicleTicks(benchmark::State& bench) {
  const double ticks = static_cast<double>(bench.iterations()) * kVehicles;
  bench.counters["per_vehicle_tick"] =
      benchmark::Counter(ticks, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  // At 20 Hz, on as many cores as there are threads.
  bench.counters["vehicle_hours_per_minute"] =
      benchmark::Counter(ticks / 20 / 3600 * 60, benchmark::Counter::kIsRate);
}

double ReachOf(const benchmark::State& bench) { return static_cast<double>(bench.range(0)); }

void VirtualFleetAdvance(benchmark::State& bench) {
  const Scenario scenario = Fleet(ReachOf(bench));
  VirtualFleet fleet(scenario);
  for (auto _ : bench) fleet.Advance();
  CountVehicleTicks(bench);
}
BENCHMARK(VirtualFleetAdvance)
    ->Arg(5)
    ->Arg(100)
    ->Threads(1)
    ->Threads(2)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

void VirtualRadio(benchmark::State& bench) {
  const Scenario scenario = Fleet(ReachOf(bench));
  Radio radio(scenario, {.loss = 0.05}, 1);
  std::vector<RadioPlace> places;
  for (std::uint32_t i = 0; i < kVehicles; ++i) places.push_back({Place(i), true});
  std::vector<ReceivedBeacon> heard;
  std::vector<QosEvent> events;
  Beacon beacon;
  beacon.boot_epoch = 1;
  std::uint32_t tick = 0;
  for (auto _ : bench) {
    ++tick;
    radio.BeginTick(Tick{tick}, 0.05 * tick, places);
    for (std::uint32_t i = 0; i < kVehicles; ++i) {
      heard.clear();
      events.clear();
      radio.Hear(i, &heard);
      radio.Notice(i, &events);
      benchmark::DoNotOptimize(heard.data());
      beacon.world_from_body.position_world = Place(i);
      beacon.seq = tick;
      radio.Transmit(i, Tick{tick}, beacon);
    }
  }
  CountVehicleTicks(bench);
}
BENCHMARK(VirtualRadio)->Arg(5)->Arg(100)->Unit(benchmark::kMicrosecond);

void VirtualWorld(benchmark::State& bench) {
  const Scenario scenario = Fleet(5);
  Run run(scenario, WorldEpoch{1});
  for (const VehicleOptions& options : scenario.vehicles) run.Join(options.id);
  run.Start();
  std::vector<MotorCommand> commands(kVehicles);
  for (auto _ : bench) {
    for (std::uint32_t i = 0; i < kVehicles; ++i) {
      commands[i] = {.vehicle = VehicleId{i + 1},
                     .epoch = WorldEpoch{1},
                     .tick = run.Now(),
                     .target = {3.0, 3.0}};
    }
    run.Advance(commands);
  }
  CountVehicleTicks(bench);
}
BENCHMARK(VirtualWorld)->Unit(benchmark::kMicrosecond);

void VirtualInvariants(benchmark::State& bench) {
  const Scenario scenario = Fleet(5);
  Invariants invariants(scenario, {});
  std::vector<Observed> observed(kVehicles);
  for (std::uint32_t i = 0; i < kVehicles; ++i) {
    observed[i].vehicle = VehicleId{i + 1};
    observed[i].present = observed[i].lives = true;
    observed[i].forward_m_s = i % 2 == 0 ? 0.3 : 0;
    observed[i].order = {.speed_bucket = 50 - i, .vehicle = VehicleId{i + 1}};
    if (i % 2 == 0) continue;
    observed[i].decision = {.rule = Rule::kGiveWay, .peer = VehicleId{i}};
    observed[i].gives_way_to = VehicleId{i};
  }
  std::uint32_t tick = 0;
  for (auto _ : bench) {
    ++tick;
    for (Observed& vehicle : observed) vehicle.answered = Tick{tick};
    invariants.Observe(Tick{tick}, 0.05 * tick, observed, {});
  }
  CountVehicleTicks(bench);
}
BENCHMARK(VirtualInvariants)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace giveway::sim
