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
  // Ends the run before its time.
  void End(std::string reason);

  // Advances one tick: applies the commands, moves, finds contacts, senses, judges. Ends by itself
  // when everyone living has arrived, the duration is over, or a vehicle fell silent unplanned.
  void Advance(std::span<const MotorCommand> commands);

  Tick Now() const;
  RunState State() const;
  double TimeSeconds() const;  // since the start signal; 0 before it
  // What the last Advance produced; valid until the next.
  std::span<const RangeScan> Scans() const;
  std::span<const Truth> Truths() const;
  std::span<const WorldEvent> Events() const;
  const std::string& EndReason() const;  // empty while it runs
  // Verdict and figures; complete once State() is kEnded. Reaction times are the caller's.
  RunFigures Figures() const;
  std::uint64_t Hash() const;
};

}  // namespace giveway::sim
