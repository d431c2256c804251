// All of a run and its participants that a restarted world needs to continue: as a value, and as
// bytes. The bytes carry a version and a checksum; anything that is not exactly what ToBytes wrote
// is refused. Knows no files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim_world/checkpoint.h"
#include "sim_world/faults/world_faults.h"
#include "sim_world/run/fault_plan.h"
#include "sim_world/run/liveness_monitor.h"
#include "sim_world/run/roster.h"
#include "sim_world/run/run_evaluator.h"

namespace giveway::sim {

struct RunCheckpoint {
  WorldEpoch epoch = kNoEpoch;  // the one it was taken in
  bool started = false;
  std::uint32_t ticks_run = 0;
  std::uint32_t event_seq = 0;                   // of the last event in that epoch
  std::vector<FaultPlan::State> faults;          // the scenario's
  std::vector<WorldFaults::State> world_faults;  // of a schedule, active
  std::vector<RunEvaluator::Track> tracks;
  std::vector<LivenessMonitor::Entry> liveness;
  Checkpoint world;
};

struct FleetCheckpoint {
  std::uint64_t scenario = 0;  // the caller's mark of the scenario; that of another is refused
  RunCheckpoint run;
  std::vector<Slot> slots;
};

std::string ToBytes(FleetCheckpoint checkpoint);
// The checkpoint, or why the bytes are none.
std::variant<FleetCheckpoint, std::string> FromBytes(std::string_view bytes);

}  // namespace giveway::sim
