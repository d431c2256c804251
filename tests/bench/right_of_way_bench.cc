// Delay and throughput of our vehicles at the crossing and in the swarm, against a reservation
// scheme in order of arrival and reciprocal velocity obstacles, which drive the same bodies from
// the same starts to the same goals. Nothing is lost on the radio. What is measured is simulated
// time: the same on any machine. GIVEWAY_CASES sets the seeds a size, 40 without it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "services/runtime/parallel_for.h"
#include "sim_world/virtual/generators.h"
#include "tests/bench/baseline/pilot.h"
#include "tests/bench/baseline/reservation.h"
#include "tests/bench/baseline/rvo.h"

namespace giveway::bench {
namespace {

constexpr std::array<std::uint32_t, 6> kSizes = {2, 4, 8, 16, 32, 50};
constexpr int kSeeds = 40;

int Seeds() {
  const char* wanted = std::getenv("GIVEWAY_CASES");
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : kSeeds;
}

struct Driver {
  std::string_view name;
  Crossed (*run)(const Scenario& scenario);
};

Crossed RunWithReservation(const Scenario& scenario) {
  Reservation reservation(scenario);
  return RunWithPilot(scenario, &reservation);
}

Crossed RunWithRvo(const Scenario& scenario) {
  Rvo rvo(scenario);
  return RunWithPilot(scenario, &rvo);
}

constexpr std::array kDrivers = {Driver{"cooperative", RunWithBrains},
                                 Driver{"reservation", RunWithReservation},
                                 Driver{"rvo", RunWithRvo}};

// Many runs together.
struct Sum {
  double vehicles = 0;
  double delay_s = 0;
  double arrived = 0;
  double contacts = 0;
  double took_s = 0;

  void Add(const Crossed& crossed) {
    vehicles += crossed.vehicles;
    for (const double delay : crossed.delays_s) delay_s += delay;
    arrived += crossed.arrived;
    contacts += crossed.contacts;
    took_s += crossed.took_s;
  }
  void Add(const Sum& other) {
    vehicles += other.vehicles;
    delay_s += other.delay_s;
    arrived += other.arrived;
    contacts += other.contacts;
    took_s += other.took_s;
  }
  double MeanDelay_s() const { return delay_s / vehicles; }
};

// Every seed of a size with one driver, added up in order of the seeds.
Sum RunSeeds(const sim::Generator& generator, std::uint32_t vehicles, const Driver& driver,
             const ParallelFor& parallel) {
  std::vector<Crossed> runs(static_cast<std::size_t>(Seeds()));
  parallel(runs.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto seed = static_cast<std::uint32_t>(i + 1);
      runs[i] = driver.run(generator.make({.vehicles = vehicles, .seed = seed}));
    }
  });
  Sum sum;
  for (const Crossed& run : runs) sum.Add(run);
  return sum;
}

using Sums = std::array<Sum, kDrivers.size()>;

// What is counted of a size, or of all sizes together.
void Count(const Sums& sums, const std::string& ending, benchmark::State* state) {
  for (std::size_t i = 0; i < kDrivers.size(); ++i) {
    const std::string name{kDrivers[i].name};
    state->counters[name + "_delay_s" + ending] = sums[i].MeanDelay_s();
    state->counters[name + "_per_min" + ending] = sums[i].arrived / sums[i].took_s * 60;
    state->counters[name + "_contacts" + ending] = sums[i].contacts;
    state->counters[name + "_missing" + ending] = sums[i].vehicles - sums[i].arrived;
  }
  state->counters["delay_ratio" + ending] = sums[0].MeanDelay_s() / sums[1].MeanDelay_s();
}

void Compare(benchmark::State& state, std::string_view place) {
  const sim::Generator& generator = *sim::FindGenerator(place);
  ParallelPool pool(std::thread::hardware_concurrency());
  const ParallelFor parallel = pool.Function();
  for (auto _ : state) {
    Sums all;
    for (const std::uint32_t vehicles : kSizes) {
      Sums sums;
      for (std::size_t i = 0; i < kDrivers.size(); ++i) {
        sums[i] = RunSeeds(generator, vehicles, kDrivers[i], parallel);
        all[i].Add(sums[i]);
      }
      Count(sums, "_" + std::to_string(vehicles), &state);
    }
    Count(all, "", &state);
  }
}

void RightOfWayCrossing(benchmark::State& state) { Compare(state, "crossing"); }
BENCHMARK(RightOfWayCrossing)->Iterations(1)->Unit(benchmark::kSecond);

void RightOfWaySwarm(benchmark::State& state) { Compare(state, "swarm"); }
BENCHMARK(RightOfWaySwarm)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace giveway::bench
