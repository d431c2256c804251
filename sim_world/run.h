// One run of a scenario: the world, its faults and its judge, advanced tick by tick. Pure: the
// caller brings commands and takes scans, truths and events away. world_main wires it to DDS, the
// virtual fleet wires it to brains in memory.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/motor_command.h"
#include "services/types/range_scan.h"
#include "services/types/scenario.h"
#include "sim_world/attendance.h"
#include "sim_world/event_log.h"
#include "sim_world/fault_plan.h"
#include "sim_world/judge.h"
#include "sim_world/world.h"

namespace giveway::sim {

class Run {
 public:
  Run(const Scenario& scenario, WorldEpoch epoch);

  // Puts the vehicle's body on its start pose. Its id is one of the scenario's.
  void Join(VehicleId vehicle);
  bool EveryoneJoined() const;
  // The start signal: from the next tick on bodies move and time counts.
  void Start();
  // Ends the run before its time, with the next Advance: that one brings the closing events. A run
  // ended so has not passed. Without effect once the run has ended.
  void End(std::string reason);

  // Advances one tick: applies the commands, moves, finds contacts, senses, judges. Ends by itself
  // when everyone living has arrived, the duration is over, or a vehicle fell silent unplanned.
  // After the end bodies brake, scans go on, and nothing is judged any more.
  void Advance(std::span<const MotorCommand> commands);

  Tick Now() const { return world_.Now(); }
  RunState State() const { return state_; }
  double TimeSeconds() const;  // since the start signal; 0 before it
  // What the last Advance produced; valid until the next. Scans are of the bodies present, truths
  // of everyone who joined.
  std::span<const RangeScan> Scans() const { return scans_; }
  std::span<const Truth> Truths() const { return truths_; }
  std::span<const WorldEvent> Events() const { return log_.Events(); }
  // "all_arrived", "duration_over", "process_died" or what End was given; empty while it runs.
  const std::string& EndReason() const { return end_reason_; }
  // Verdict and figures; complete once State() is kEnded. Reaction times are the caller's.
  RunFigures Figures() const { return figures_; }
  const CommandCounters& Commands() const { return world_.Commands(); }
  // Of ticks since the start signal, poses, wheels and contacts: equal runs have equal hashes
  // however long they waited.
  std::uint64_t Hash() const;

 private:
  std::uint32_t TicksRun() const;
  void Take(std::span<const MotorCommand> commands);
  void FollowFaults();
  void CheckEnd();
  bool EveryoneLivingArrived() const;
  void Finish();
  Outcome TheOutcome() const;
  void Publish();

  Scenario scenario_;
  WorldEpoch epoch_;
  World world_;
  FaultPlan faults_;
  Judge judge_;
  Attendance attendance_;
  EventLog log_;
  RunState state_ = RunState::kWaiting;
  std::uint32_t duration_ticks_;
  std::optional<Tick> start_;  // the last tick before bodies move
  std::optional<Tick> end_;    // the tick the run ended with
  std::string asked_end_;
  std::string end_reason_;
  RunFigures figures_;
  std::vector<RangeScan> scans_;
  std::vector<Truth> truths_;
};

}  // namespace giveway::sim
