// One soak from the first process to the last: starts the fleet, injects the scheduled faults,
// observes it, heals it, stops it, and passes the observations on. Judged elsewhere:
// soak_verdict.h.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/accounting/fleet_accounting.h"
#include "services/faults/fault.h"
#include "services/fleetctl/process/fleet_processes.h"
#include "services/fleetctl/process/fleet_restarts.h"
#include "services/fleetctl/run/black_box.h"
#include "services/fleetctl/run/invariant_watch.h"
#include "services/fleetctl/soak/fault_clock.h"
#include "services/fleetctl/soak/fleet_course.h"
#include "services/fleetctl/soak/fleet_timing.h"
#include "services/fleetctl/soak/host_faults/attackers.h"
#include "services/fleetctl/soak/host_faults/qos_orders.h"
#include "services/fleetctl/soak/near_misses.h"
#include "services/fleetctl/soak/pause_meter.h"
#include "services/fleetctl/soak/process_faults.h"
#include "services/fleetctl/soak/resource_series.h"
#include "services/fleetctl/soak/ring_keeper.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/soak_seen.h"
#include "services/fleetctl/soak/soak_watch.h"
#include "services/fleetctl/stopwatch/stall_monitor.h"
#include "services/link/observer_link.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

class SoakSession {
 public:
  // `limits`: the promises of the profile set. `scenario` and `schedule` outlive the session.
  // Throws LinkError, StartError.
  SoakSession(const FleetSpec& spec, const Scenario& scenario, const faults::Schedule& schedule,
              const SoakPhases& phases, const Limits& limits, FaultTools tools);

  // The observations so far, without the slopes of current lives, which take time. Returns how long
  // until it is called again.
  using Saved = std::function<Nanoseconds(SoakSeen so_far)>;

  // Returns when the last process is gone.
  SoakSeen Run(const Saved& save = {});

 private:
  double TimeOfTick(Tick tick) const;  // since the start signal, by this clock
  double WorldLag_s() const;           // of the world's time behind this clock
  bool AreFaultsOver(SteadyTime now) const;
  bool IsOver(SteadyTime now) const;
  void NoteWhatDidNotEnd(SteadyTime now);
  void NoteBroken();
  void NotePauses(SteadyTime now);
  void Gather(SoakSeen* seen) const;
  void SaveIfDue(SteadyTime now);
  bool WaitUntilAllDrive();
  void Turn();
  void Drain();
  std::uint64_t BrokenSoFar() const;
  void KeepRings(SteadyTime now);
  void Begin(std::size_t fault);
  void CutOff(std::span<const FaultEdge> edges);
  void CarryOut(std::span<const FaultEdge> edges);
  void NoteProcessEffects();
  void NoteOrder(std::size_t fault, const QosOrders::Ended& order);
  void HearLines();
  void NoteEnds();
  bool MayEnd(const MemberEnd& end) const;
  void NoteUnplannedEnd(const MemberEnd& end);
  void NoteUnplannedEnd(MemberId member, std::string how, std::vector<std::string> last_lines);
  void NoteFailedStart(const FailedStart& start);
  void RestartThoseThatEnded(SteadyTime now);
  void Sample(SteadyTime now);
  void FollowCourse(SteadyTime now);
  void ShowProgress(SteadyTime now);
  void Stop();

  const faults::Schedule& schedule_;
  SoakPhases phases_;
  const Limits limits_;  // the promises of the profile set
  std::vector<VehicleId> fleet_;
  SoakWatch watch_;
  InvariantWatch invariants_;
  const link::LinkOptions own_link_;
  link::ObserverLink observer_;
  FleetProcesses processes_;
  Attackers attackers_;
  ProcessFaults faults_;
  FleetRestarts restarts_;  // of those that ended by themselves
  FaultClock clock_;
  FaultClock world_clock_;  // of the faults that the world carries out, by its own time
  ResourceSeries resources_;
  FleetCourse course_;
  PauseMeter pauses_;
  StallMonitor stalls_{std::chrono::milliseconds(20)};  // limits of detection are 100 ms and more
  NearMisses near_;
  BlockCounts near_by_block_;
  FleetTiming timing_;
  FleetAccounting accounting_;
  std::optional<RingKeeper> rings_;
  std::optional<BlackBox> black_box_;  // like rings_: absent without them
  std::uint64_t broken_before_ = 0;    // when rings were last kept
  double tick_period_s_;
  WorldTime world_time_;
  std::vector<BrokenInvariant> broken_;
  SoakSeen seen_;
  std::uint64_t samples_ = 0;
  SteadyTime turned_{0};
  SteadyTime next_sample_{0};
  SteadyTime next_progress_{0};
  Saved save_;
  SteadyTime next_save_{0};
  bool stopping_ = false;
};

}  // namespace giveway::fleetctl
