// All that a soak saw, as values: what its verdict is made of.
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

// One fault as it went.
struct FaultCourse {
  std::optional<SteadyTime> began;
  std::optional<SteadyTime> ended;  // or, of one that takes no time, the moment it started
  std::string effect;               // that was seen; empty: none yet
  // By the first peer, by each mechanism that reported it.
  std::array<std::optional<SteadyTime>, kMechanisms> noticed;
  std::optional<SteadyTime> recovered;  // after its end all that it faulted were well again
};

// A process ended that was not to.
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
  std::vector<UnplannedEnd> ends;
  std::uint32_t restarts = 0;  // after those
  // When each vehicle that lives was well again after the last fault's end, seconds; absent: never.
  std::map<VehicleId, std::optional<double>> healing;
  // Of each that lives: the longest time without a status of it since the last fault ended.
  std::map<VehicleId, double> silent_s;
  std::vector<BrokenInvariant> broken;  // the first ones
  std::uint64_t broken_counted = 0;
  std::vector<NearMiss> near_misses;
  std::uint64_t near_misses_counted = 0;
  std::vector<ModeChange> modes;
  std::uint64_t modes_counted = 0;
  std::vector<ResourceSlope> slopes;
  std::uint64_t lives_too_short = 0;
  FleetTiming timing{Nanoseconds{0}};
  FleetAccounting accounting;
  std::vector<KeptRings> kept_rings;
  MachinePauses pauses;
  std::map<VehicleId, double> step_p99_us;  // the highest that each said of itself
};

}  // namespace giveway::fleetctl
