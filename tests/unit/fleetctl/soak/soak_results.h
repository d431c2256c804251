// A soak of three minutes as a supervisor would fill it, by a seed: two of different seeds differ
// by chance alone.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "services/fleetctl/soak/resource_series.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/soak_result.h"
#include "services/statistics/slope.h"
#include "services/types/math/random.h"

namespace giveway::fleetctl {

inline constexpr std::uint32_t kSampleVehicles = 8;

// The values of one block more.
inline void AddBlock(SoakHistogram* measured, const std::vector<double>& values_ms) {
  Histogram block;
  for (const double value_ms : values_ms) block.Add(static_cast<std::int64_t>(value_ms * 1e6));
  measured->blocks.push_back(
      {block.Count(), std::llround(block.Mean()), block.Quantile(0.5), block.Quantile(0.99)});
  measured->histogram.Merge(block);
}

inline SoakHistogram SampleHistogram(const std::string& name, Random* random, double median_ms,
                                     double sigma_ms) {
  SoakHistogram measured{.name = name, .budgets = {{0.99, 200'000'000}, {0.5, 100'000'000}}};
  for (std::size_t block = 0; block < kSoakBlocks; ++block) {
    std::vector<double> values_ms(150);
    for (double& value_ms : values_ms) {
      value_ms = std::abs(median_ms + random->Gaussian(sigma_ms));
    }
    AddBlock(&measured, values_ms);
  }
  return measured;
}

// `growth` bytes a second under 50 kB of noise.
inline ResourceSlope SampleSlope(const std::string& process, Random* random, double growth) {
  std::vector<statistics::Sample> samples;
  for (int t = 10; t < 180; ++t) {
    samples.push_back({static_cast<double>(t), 2e7 + growth * t + random->Gaussian(50'000)});
  }
  ResourceSlope row{.process = process, .slope = *statistics::TheilSen(samples)};
  row.last = samples.back().value;
  row.curve = statistics::BlockMedians(samples, 60);
  return row;
}

inline SoakFault SampleFault(std::uint32_t nth, Random* random) {
  SoakFault fault{.rule = nth % 2 == 0 ? "stop" : "cut",
                  .nth = nth / 2,
                  .at_s = 15 + 6.0 * nth,
                  .for_s = nth % 2 == 0 ? 3.0 : 0.0,
                  .kind = nth % 2 == 0 ? "pause" : "kill",
                  .target = "vehicle " + std::to_string(nth % kSampleVehicles + 1),
                  .observed = true,
                  .observed_how = nth % 2 == 0 ? "beacons ceased" : "waitpid: signal 9"};
  fault.observed_s = fault.at_s + 0.01;
  fault.noticed_after_s = 0.3 + random->Uniform(0, 0.1);
  fault.promised_s = 0.5;
  fault.recovered_after_s = 1.0 + random->Uniform(0, 1);
  return fault;
}

inline SoakResult SampleSoak(std::uint64_t seed) {
  Random random(seed);
  SoakResult result;
  result.verdict = SoakVerdict::kPassed;
  result.scenario = "warehouse_loop";
  result.seed = seed;
  result.planned_s = 180;
  result.ran_s = 180;
  result.vehicles = kSampleVehicles;
  result.domain = 7;
  result.faults_file = "everything";
  result.qos_set = "default";
  result.qos_hash = "0123456789abcdef";
  result.versions = {{{"fleetctl", "1b54d370a5c2"}}, "2.9.1", "6.1.0", 2};
  result.command = "fleetctl soak warehouse_loop --faults everything --duration 3m --seed 1";
  for (std::uint32_t nth = 0; nth < 24; ++nth) result.faults.push_back(SampleFault(nth, &random));
  for (int i = 0; i < 30; ++i) {
    result.near_misses.push_back({.time_s = 6.0 * i,
                                  .vehicle = VehicleId{1},
                                  .other = VehicleId{2},
                                  .x_m = random.Uniform(-10, 10),
                                  .y_m = random.Uniform(-5, 5),
                                  .distance_m = random.Uniform(0.05, 0.3)});
  }
  result.near_misses_counted = 30;
  result.block_s = BlockSeconds(result.planned_s);
  BlockCounts near_by_block(result.block_s);
  for (const NearMiss& miss : result.near_misses) near_by_block.Note(miss.time_s, 1);
  result.near_misses_by_block = near_by_block.Counts();
  for (std::uint32_t vehicle = 1; vehicle <= kSampleVehicles; ++vehicle) {
    for (int i = 0; i < 12; ++i) {
      const char* mode = i % 3 == 0 ? "drive" : i % 3 == 1 ? "give_way" : "steer_away";
      result.modes.push_back({15.0 * i + vehicle, VehicleId{vehicle}, mode});
    }
  }
  result.modes_counted = result.modes.size();
  result.histograms = {SampleHistogram("reaction", &random, 90, 15),
                       SampleHistogram("beacon_age", &random, 40, 12),
                       SampleHistogram("tick_jitter", &random, 0.2, 0.1)};
  for (std::uint32_t vehicle = 1; vehicle <= kSampleVehicles; ++vehicle) {
    result.slopes.push_back(SampleSlope("vehicle-" + std::to_string(vehicle), &random, 0));
  }
  result.slopes.push_back(SampleSlope("vehicle-1", &random, 0));
  result.slopes.back().kind = ResourceKind::kHeapBytes;
  MarkLeaks(&result.slopes, 0);
  result.accounting = {{.writer = "vehicle 1",
                        .reader = "vehicle 2",
                        .topic = "fleet/beacon",
                        .sent = 3600,
                        .accepted = 3500,
                        .not_heard = 60,
                        .refused = 10,
                        .superseded = 20,
                        .lost = 10}};
  result.pauses = {3, 0.4, 0.2, 0.002};
  result.narrowest_margin = NarrowestMargin{77.5, VehicleId{3}, 0.4, 1.6, 0.75};
  result.restarts_planned = 12;
  result.supervisor_cpu_share = 0.031;
  return result;
}

}  // namespace giveway::fleetctl
