// World and brains in one thread and in virtual time: the same Run and the same Vehicle::Step as in
// the real fleet, with a radio in memory between them. A beacon of tick k is received at tick k + 1
// at the earliest, as in a real run. Knows no clock and no middleware.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "services/types/scenario.h"
#include "services/vehicle/vehicle.h"
#include "sim_world/run/run.h"
#include "sim_world/virtual/radio.h"
#include "sim_world/virtual/virtual_plan.h"

namespace giveway::sim {

class VirtualFleet {
 public:
  // Every vehicle joins and the run starts at once. Without a plan nothing is lost and no process
  // fails except as the scenario plans.
  explicit VirtualFleet(const Scenario& scenario, const VirtualPlan& plan = {});

  // One tick for world and brains. False once the run has ended.
  bool Advance();
  // Advances until the run has ended.
  void Finish();

  const Run& World() const { return run_; }
  const Scenario& TheScenario() const { return scenario_; }
  std::size_t Size() const { return members_.size(); }
  const Vehicle& Brain(std::size_t index) const { return *members_[index].brain; }
  // The vehicle's last outputs.
  const Outputs& OutputsOf(std::size_t index) const { return members_[index].outputs; }
  // True if the vehicle's process answered this tick: it runs and is not paused.
  bool Answered(std::size_t index) const { return members_[index].answered; }
  // Whether a beacon was lost, delayed, doubled or cut off by this fault of the schedule's so far;
  // known until some ticks after its end.
  bool HasMetBeacons(const faults::Fault& fault) const;
  // Every event of the run so far.
  const std::vector<WorldEvent>& History() const { return history_; }
  // Of every command given so far, in order: fleets that ever differed have different hashes.
  std::uint64_t CommandsHash() const { return commands_hash_; }

 private:
  enum class Process : std::uint8_t { kRuns, kPaused, kGone };
  struct Member {
    VehicleId id = kNoVehicle;
    std::unique_ptr<Vehicle> brain;
    Process process = Process::kRuns;
    std::uint32_t back_at_tick = 0;  // of a pause or restart; 0: never
    bool restarts = false;
    bool answered = false;
    std::uint32_t slow_since_tick = 0;
    std::uint32_t slow_until_tick = 0;  // not any more
    double share = 1;                   // of ticks that it answers while it is slow
    Outputs outputs;
    std::optional<RosterEntry> placed;   // what a new process is sent before its first scan
    std::vector<ReceivedBeacon> queued;  // in the reader of a paused process
    std::optional<PoseFix> fix;          // in its reader
  };
  struct DueFault {
    ProcessFault fault;
    std::size_t member;
    bool done = false;
  };

  void CarryOutFaults();
  void EndPauseOf(std::size_t index);
  void CarryOut(DueFault* due);
  bool IsThere(const VehicleOptions& options);
  bool Skips(const Member& member) const;
  void Break(const ProcessFault& fault, Member* member);
  void BringBack(std::size_t index);
  void UpdateRadioPositions();
  void Think();
  void Step(const RangeScan& scan, std::size_t index);
  void Queue(std::size_t index);
  Member* Find(VehicleId vehicle);

  VirtualPlan plan_;  // the schedule's faults of processes and radio among its own
  Scenario scenario_;
  Run run_;
  Radio radio_;
  std::vector<Member> members_;      // in the scenario's order, by which the radio numbers them
  std::vector<DueFault> faults_;     // of the plan itself
  std::vector<DueFault> scheduled_;  // of its schedule, in order of time
  std::size_t next_scheduled_ = 0;
  std::uint32_t last_boot_epoch_ = 0;
  std::vector<RadioPlace> places_;
  std::vector<ReceivedBeacon> heard_;
  std::vector<QosEvent> events_;
  Inputs inputs_;
  std::vector<MotorCommand> commands_;
  std::vector<WorldEvent> history_;
  std::uint64_t commands_hash_ = 0;
};

}  // namespace giveway::sim
