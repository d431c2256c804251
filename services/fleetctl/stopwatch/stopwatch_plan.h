// Which vehicle is faulted when: the waves of one stopwatch fleet from a seed, the blackouts that
// implement cuts, and the scenario its vehicles drive. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "services/fleetctl/stopwatch/stopwatch_table.h"
#include "services/types/ids.h"

namespace giveway::fleetctl {

// One vehicle's fault, counted from the start of its wave.
struct FaultInjection {
  VehicleId target = kNoVehicle;
  Nanoseconds after{0};
};

// Faults whose effects are awaited together: most of a trial is the wait for the participant lease.
// At least half of the fleet has no fault, and watches.
struct Wave {
  // For cuts since the start signal; any other wave starts when every vehicle is well.
  Nanoseconds begin{0};
  Nanoseconds end{0};                      // of the blackouts
  std::vector<FaultInjection> injections;  // in the order of time
};

// Waves start at any phase of the beacons: their faults spread over this period.
inline constexpr Nanoseconds kWaveSpread{1'500'000'000};

std::vector<VehicleId> StopwatchVehicles(std::uint32_t count);

// `trials` faults in all. Cuts: at most TargetsOf, in one wave, because Fast DDS 2.9.1 does not
// always rediscover peers that were dropped on one side only, and the next wave would wait forever.
std::vector<Wave> PlanWaves(Fault fault, std::uint32_t trials, std::span<const VehicleId> fleet,
                            const Limits& limits, std::uint64_t seed);

// How many vehicles of a fleet are faulted in a wave, if there are trials left for them.
std::uint32_t TargetsOf(std::size_t fleet);

// True of faults that are implemented as blackouts.
constexpr bool IsCut(Fault fault) { return fault == Fault::kCut || fault == Fault::kOneWay; }

// The --impair of `hearer`; empty for none.
std::string BlackoutsOf(VehicleId hearer, Fault fault, std::span<const Wave> waves,
                        std::span<const VehicleId> fleet);

// Each vehicle drives round a small square of its own forever, far from the others and in reach of
// all. The world keeps the bodies of vehicles that are away.
std::string StopwatchScenario(std::span<const VehicleId> fleet);

}  // namespace giveway::fleetctl
