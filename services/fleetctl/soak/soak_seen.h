// All observations of a soak, as values: the input of its verdict.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/accounting/fleet_accounting.h"
#include "services/faults/fault.h"
#include "services/fleetctl/process/fleet_commands.h"
#include "services/fleetctl/soak/fleet_timing.h"
#include "services/fleetctl/soak/soak_result.h"
#include "services/fleetctl/stopwatch/stopwatch_table.h"
#include "services/types/time.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::fleetctl {

// The course of one fault.
struct FaultCourse {
  std::optional<SteadyTime> began;
  std::optional<SteadyTime> ended;  // or, for an instantaneous one, when it started
  std::string effect;               // the observed effect; empty: none yet
  std::string met_nothing;  // it was active, and why there was nothing to act on; empty: there was
  std::string failure;      // of the last attempt to inject or undo it; empty: none
  bool not_undone = false;  // that attempt was to undo it
  bool cut_off = false;     // by the end of the soak
  // By the first peer, for each mechanism that reported it.
  std::array<std::optional<SteadyTime>, kMechanisms> noticed;
  // The machine's longest pause while each mechanism had to report it; absent: not known, or not
  // expected.
  std::array<std::optional<Nanoseconds>, kMechanisms> paused;
  std::optional<SteadyTime> recovered;  // after its end all that it affected recovered
};

// A process ended by itself, and none of its faults may have ended it.
struct UnplannedEnd {
  double time_s = 0;  // since the start signal
  MemberId member;
  std::string how;
  std::vector<std::string> last_lines;
};

struct BrokenInvariant {
  double time_s = 0;  // since the start signal
  sim::Violation what;
};

struct SoakSeen {
  bool started = false;      // every vehicle drove before the first fault
  bool interrupted = false;  // by the operator
  SteadyTime started_at{0};
  double lasted_s = 0;               // since the start signal
  std::vector<FaultCourse> courses;  // of each fault of the schedule
  std::vector<UnplannedEnd> ends;    // the first ones
  std::uint32_t restarts = 0;        // after all of those
  // From then until the end the world's time stood, and was not waited for any more.
  std::optional<double> world_stood_from_s;
  // It reached its end, and its last fault had not: nothing was seen of how the fleet heals.
  bool faults_outlasted_it = false;
  // When each live vehicle had recovered after the last fault's end, seconds; absent: never.
  std::map<VehicleId, std::optional<double>> healing;
  // For each live vehicle: the longest time without a status of it since the last fault ended.
  std::map<VehicleId, double> silent_s;
  std::vector<BrokenInvariant> broken;  // the first ones
  std::uint64_t broken_counted = 0;
  // Ticks of the world for which every invariant was judged, and those of which too little was
  // seen.
  std::uint64_t ticks_judged = 0;
  std::uint64_t ticks_unseen = 0;
  std::vector<NearMiss> near_misses;
  std::uint64_t near_misses_counted = 0;
  std::vector<std::uint64_t> near_misses_by_block;
  std::vector<ModeChange> modes;
  std::uint64_t modes_counted = 0;
  std::vector<ResourceSlope> slopes;
  std::uint64_t lives_too_short = 0;
  std::optional<double> supervisor_cpu_share;  // of the fleet's processor time
  FleetTiming timing{Nanoseconds{0}};
  FleetAccounting accounting;
  std::vector<KeptRings> kept_rings;
  MachinePauses pauses;
  std::map<VehicleId, double> step_p99_us;  // the highest that each reported of itself
};

}  // namespace giveway::fleetctl
