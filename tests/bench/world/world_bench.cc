// What one tick of the world costs: World::Advance(driving) with motion, contacts, walls and all 16
// ultrasonics of every vehicle, on one core, in the field of world_field.h. Taking commands in and
// scans out is not in it. Worlds that are compared take turns in the same loop, so that whatever
// else the machine does falls on all; a figure is the ratio of the medians over the turns.
#include <benchmark/benchmark.h>

#include <span>
#include <vector>

#include "tests/bench/measure.h"
#include "tests/bench/world/world_field.h"

namespace giveway::bench {
namespace {

constexpr int kTurns = 21;
constexpr std::uint32_t kVehicleStepsATurn = 20'000;

// A world, and what a vehicle-step in it cost in each turn.
class Contestant {
 public:
  Contestant(FieldSize size, SonarTier tier)
      : vehicles_(size.Vehicles()), world_(FieldOf(size, tier)) {
    world_.WarmUp();
  }

  void TakeTurn() {
    const std::uint32_t ticks = kVehicleStepsATurn / vehicles_;
    double spent_s = 0;
    for (std::uint32_t tick = 0; tick < ticks; ++tick) {
      world_.Command();
      spent_s += CpuSecondsOf([&] { world_.Advance(); });
    }
    costs_s_.push_back(spent_s / (ticks * vehicles_));
  }
  double Cost_s() const { return Median(costs_s_); }
  std::uint32_t Contacts() const { return world_.Contacts(); }

 private:
  std::uint32_t vehicles_;
  BusyWorld world_;
  std::vector<double> costs_s_;
};

void TakeTurns(std::span<Contestant> contestants) {
  for (int turn = 0; turn < kTurns; ++turn) {
    for (Contestant& contestant : contestants) contestant.TakeTurn();
  }
}

void WorldSizes(benchmark::State& state) {
  Contestant contestants[] = {{kHundred, SonarTier::kIdeal},
                              {kThousand, SonarTier::kIdeal},
                              {kTenThousand, SonarTier::kIdeal}};
  for (auto _ : state) TakeTurns(contestants);
  const double costs_s[] = {contestants[0].Cost_s(), contestants[1].Cost_s(),
                            contestants[2].Cost_s()};
  state.counters["steps_per_s_100"] = 1 / costs_s[0];
  state.counters["steps_per_s_1000"] = 1 / costs_s[1];
  state.counters["steps_per_s_10000"] = 1 / costs_s[2];
  const auto [least, most] = std::ranges::minmax(costs_s);
  state.counters["flatness"] = most / least;
  state.counters["contacts_1000"] = contestants[1].Contacts();
}
BENCHMARK(WorldSizes)->Iterations(1);

void WorldTiers(benchmark::State& state) {
  Contestant contestants[] = {{kThousand, SonarTier::kIdeal},
                              {kThousand, SonarTier::kTypical},
                              {kThousand, SonarTier::kP3dx},
                              {kThousand, SonarTier::kCrosstalk}};
  for (auto _ : state) TakeTurns(contestants);
  state.counters["steps_per_s_ideal"] = 1 / contestants[0].Cost_s();
  state.counters["steps_per_s_typical"] = 1 / contestants[1].Cost_s();
  state.counters["steps_per_s_p3dx"] = 1 / contestants[2].Cost_s();
  state.counters["steps_per_s_crosstalk"] = 1 / contestants[3].Cost_s();
}
BENCHMARK(WorldTiers)->Iterations(1);

}  // namespace
}  // namespace giveway::bench
