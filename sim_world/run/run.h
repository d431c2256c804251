// One run of a scenario: the world, its faults and its evaluator, advanced tick by tick. Pure: the
// caller passes commands in and takes scans, truths and events out. The world service connects it
// to DDS, the virtual fleet connects it to brains in memory.
//
// A closed run knows every vehicle from the start and ends when its vehicles have arrived or one
// dies. In an open one (Scenario::spawns) vehicles come and go, and it lasts for its duration, or
// until End is called if that is unlimited.
//
// A fault schedule may be added to the scenario: the world's own faults are injected here, and each
// start and end is an event. Of all others it only knows which vehicles are meant to be silent. If
// the schedule stops or restarts processes, a closed run too continues without a silent vehicle,
// waits for it, and takes it back.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/motor_command.h"
#include "services/types/parallel.h"
#include "services/types/range_scan.h"
#include "services/types/scenario.h"
#include "sim_world/auxiliary_sensors.h"
#include "sim_world/faults/planned_silence.h"
#include "sim_world/faults/world_faults.h"
#include "sim_world/pose_sensing.h"
#include "sim_world/run/event_log.h"
#include "sim_world/run/fault_plan.h"
#include "sim_world/run/liveness_monitor.h"
#include "sim_world/run/run_checkpoint.h"
#include "sim_world/run/run_evaluator.h"
#include "sim_world/run/traffic_lights.h"
#include "sim_world/world.h"

namespace giveway::sim {

class Run {
 public:
  Run(const Scenario& scenario, WorldEpoch epoch, ParallelFor parallel = OnThisThread,
      const FaultSchedule& schedule = {});

  // Puts the body of one of the scenario's vehicles on its start pose.
  void Join(VehicleId vehicle);
  // The same for any vehicle, also during the run. A body that still stands after its vehicle fell
  // silent stays where it is and belongs to the vehicle again.
  void Join(const VehicleOptions& options);
  // A vehicle in the run asks for its place with the same session: its process has restarted
  // itself, and its new endpoints must be discovered before it is received again.
  void AsksAgain(VehicleId vehicle);
  // The vehicle sent a leave notice: its body is removed. Ends a closed run that has started, also
  // one that was resumed and waits.
  void Leave(VehicleId vehicle);
  bool EveryoneJoined() const;
  // The start signal: from the next tick on bodies move and time counts.
  void Start();
  // Ends the run early, with the next Advance, which brings the closing events. Such a run has not
  // passed. No effect once the run has ended.
  void End(std::string reason);

  // Advances one tick: applies the commands, moves, finds contacts, senses, judges. Ends by itself
  // when the duration is over; a closed run also when every live vehicle has arrived, when a
  // vehicle fell silent unplanned, and when no vehicle is live. After the end bodies brake, scans
  // continue, and nothing is judged any more.
  void Advance(std::span<const MotorCommand> commands);

  Tick Now() const { return world_.Now(); }
  RunState State() const { return state_; }
  double TimeSeconds() const;  // since the start signal, without pauses; 0 before it
  // What the last Advance produced; valid until the next. Scans are of the bodies present, truths
  // of every vehicle that joined.
  std::span<const RangeScan> Scans() const { return scans_; }
  std::span<const RadarScan> Radars() const { return auxiliary_.Radars(); }
  std::span<const LidarScan> Lidars() const { return auxiliary_.Lidars(); }
  std::span<const CameraScan> Cameras() const { return auxiliary_.Cameras(); }
  std::span<const PoseFix> PoseFixes() const { return pose_sensing_.Fixes(); }
  std::span<const SignalState> Signals() const { return signals_.States(); }
  std::span<const Truth> Truths() const { return truths_; }
  std::span<const WorldEvent> Events() const { return log_.Events(); }
  // "all_arrived", "duration_over", "process_died", "no_vehicle_lives", "vehicle_left" or the
  // reason given to End; empty while it runs.
  const std::string& EndReason() const { return end_reason_; }
  // Verdict and figures; complete once State() is kEnded. The caller adds reaction times.
  RunFigures Figures() const { return figures_; }
  std::uint32_t Contacts() const { return world_.Contacts(); }
  const CommandCounters& Commands() const { return world_.Commands(); }
  // Of ticks since the start signal, poses, wheels and contacts: equal runs have equal hashes
  // however long they waited.
  std::uint64_t Hash() const;

  // Adds to an answer to a vehicle where its body is and how far it is on its route; nothing if it
  // has no body.
  void Locate(const VehicleOptions& options, RosterEntry* entry) const;
  // The vehicles that the last Advance forgot, of which nothing more is reported: those that are
  // not the scenario's, a second after their bodies were removed.
  std::span<const VehicleId> Forgotten() const { return forgotten_; }

  // Null if no body of the vehicle is in the world.
  const Body* BodyOf(VehicleId vehicle) const;
  // In the scenario's order.
  std::span<const MovingObstacle> Obstacles() const { return world_.Obstacles(); }
  std::span<const SlidingDoor> Doors() const { return world_.Doors(); }
  bool IsFree(const VehicleOptions& options) const { return world_.IsFree(options); }
  // True if no process runs the vehicle any more, or not yet.
  bool IsAbandoned(VehicleId vehicle) const { return liveness_.IsAbandoned(vehicle, Now()); }

  // Everything that a run of the same scenario, in this epoch or a new one, needs to continue from
  // here.
  RunCheckpoint Save() const;
  // Continues from there, paused: bodies brake and time stands still until Start. `joined` are the
  // vehicles in the checkpoint that are not the scenario's. False if the checkpoint is not of this
  // scenario; then this run cannot be used any more.
  bool Restore(const RunCheckpoint& checkpoint, std::span<const VehicleOptions> joined);

 private:
  struct Gone {
    VehicleId vehicle = kNoVehicle;
    Tick since = kNoTick;
  };

  void Take(std::span<const MotorCommand> commands);
  void TakeAway(VehicleId vehicle);
  void ForgetGone();
  bool MayReturn(VehicleId vehicle) const;
  bool IsKilled(VehicleId vehicle) const;
  bool IsWaitedFor(VehicleId vehicle) const;
  void LogSchedule();
  void Announce(EventKind kind, VehicleId vehicle);
  void Observe();
  void FollowFaults();
  void FollowLiveness();
  void CheckEnd();
  bool EveryoneLivingArrived() const;
  bool IsEveryoneSilent() const;
  void Finish();
  Outcome TheOutcome() const;
  void Publish(bool drove);

  Scenario scenario_;
  bool open_;
  WorldEpoch epoch_;
  World world_;
  AuxiliarySensors auxiliary_;
  PoseSensing pose_sensing_;
  SignalHeads signals_;
  FaultPlan faults_;
  WorldFaults world_faults_;
  PlannedSilence silence_;
  RunEvaluator evaluator_;
  LivenessMonitor liveness_;
  EventLog log_;
  RunState state_ = RunState::kWaiting;
  std::optional<std::uint32_t> duration_ticks_;  // empty: until End
  bool started_ = false;                         // the start signal was given
  std::uint32_t ticks_run_ = 0;                  // since then, without pauses
  std::vector<WorldEvent> comings_and_goings_;   // since the last tick
  std::vector<Gone> gone_;                       // still reported, as not present
  std::vector<VehicleId> forgotten_;
  std::string asked_end_;
  std::string end_reason_;
  RunFigures figures_;
  std::vector<RangeScan> scans_;
  std::vector<Truth> truths_;
};

}  // namespace giveway::sim
