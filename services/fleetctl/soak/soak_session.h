// One soak from the first process to the last: starts the fleet, breaks it by the schedule, watches
// it, heals it, stops it, and hands on what was seen. Judged elsewhere: soak_verdict.h.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/process/fleet_processes.h"
#include "services/fleetctl/run/invariant_watch.h"
#include "services/fleetctl/soak/fault_clock.h"
#include "services/fleetctl/soak/near_misses.h"
#include "services/fleetctl/soak/pause_meter.h"
#include "services/fleetctl/soak/process_faults.h"
#include "services/fleetctl/soak/resource_series.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/soak_watch.h"
#include "services/fleetctl/stopwatch/stall_monitor.h"
#include "services/link/observer_link.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// Somebody ended who was not to.
struct UnplannedEnd {
  double time_s = 0;  // since the start signal
  MemberId member;
  std::string how;
  std::vector<std::string> last_lines;
};

// Time at which a vehicle was well again after the last fault had ended; absent: it never was.
using Healing = std::map<VehicleId, std::optional<double>>;

// All that a soak saw.
struct SoakSeen {
  bool started = false;      // everyone drove before the first fault
  bool interrupted = false;  // by the operator
  double lasted_s = 0;       // since the start signal
  std::vector<FaultCourse> courses;
  std::vector<UnplannedEnd> ends;
  Healing healing;  // seconds since the last fault's end
  std::uint32_t restarts = 0;
};

class SoakSession {
 public:
  // `scenario` and `schedule` outlive the session. Throws LinkError, StartError.
  SoakSession(const FleetSpec& spec, const Scenario& scenario, const faults::Schedule& schedule,
              const SoakPhases& phases, FaultTools tools);

  // Returns when the last process is gone.
  SoakSeen Run();

  const SoakWatch& Watch() const { return watch_; }
  const InvariantWatch& Judged() const { return invariants_; }
  const ResourceSeries& Resources() const { return resources_; }
  const PauseMeter& Pauses() const { return pauses_; }
  const StallMonitor& Stalls() const { return stalls_; }
  const NearMisses& Near() const { return near_; }
  // The first ones; and how many there were.
  const std::vector<ModeChange>& Modes() const { return modes_; }
  std::uint64_t ModesCounted() const { return modes_counted_; }
  // Since the start signal.
  double TimeOfTick(Tick tick) const;
  // Of the steady clock.
  SteadyTime StartedAt() const { return started_at_; }

 private:
  bool WaitUntilAllDrive();
  void Turn();
  void Drain();
  void CarryOut(std::span<const FaultEdge> edges);
  void NoteProcessEffects();
  void HearLines();
  void NoteEnds();
  void Sample(SteadyTime now);
  void NoteModes(SteadyTime now);
  void SeekHealing(SteadyTime now);
  void ShowProgress(SteadyTime now);
  void Stop();

  const faults::Schedule& schedule_;
  SoakPhases phases_;
  std::vector<VehicleId> fleet_;
  SoakWatch watch_;
  InvariantWatch invariants_;
  link::ObserverLink observer_;
  FleetProcesses processes_;
  ProcessFaults faults_;
  FaultClock clock_;
  ResourceSeries resources_;
  PauseMeter pauses_;
  StallMonitor stalls_;
  NearMisses near_;
  std::map<VehicleId, std::string> mode_;
  std::vector<ModeChange> modes_;
  std::uint64_t modes_counted_ = 0;
  double tick_period_s_;
  std::optional<Truth> any_truth_;
  SoakSeen seen_;
  std::uint64_t samples_ = 0;
  SteadyTime turned_{0};
  SteadyTime started_at_{0};
  SteadyTime next_sample_{0};
  SteadyTime next_progress_{0};
  std::optional<SteadyTime> healed_from_;
  bool stopping_ = false;
};

// Ids of the vehicles of a soak: those of a closed fleet's scenario, or the first of an open one.
std::vector<VehicleId> SoakFleet(const Scenario& scenario, std::uint32_t newcomers);

}  // namespace giveway::fleetctl
