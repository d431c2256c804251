// Injects the supervisor's faults into the processes of a fleet, and removes them. Nothing outlives
// this process: stopped processes are children that are killed with their parent, limits end with
// the process they apply to, and the processes started here are children too. Knows no DDS; whether
// a fault had an effect is checked elsewhere.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/fleet_processes.h"
#include "services/fleetctl/process/fleet_restarts.h"
#include "services/fleetctl/soak/host_faults/duty_cycle.h"
#include "services/fleetctl/soak/host_faults/private_shm.h"
#include "services/fleetctl/soak/host_faults/qos_orders.h"
#include "services/fleetctl/soak/host_faults/second_claim.h"
#include "services/fleetctl/soak/host_faults/steppable_clock.h"
#include "services/fleetctl/soak/host_faults/unread_log.h"

namespace giveway::fleetctl {

// What is needed to inject the faults.
struct FaultTools {
  std::vector<MemberCommand> commands;  // of every member, as it was started
  std::string fleetctl;                 // the program, for orders
  std::uint32_t domain = 0;
  std::string interface;
  std::string discovery_servers;  // as --discovery-server has them; empty: none
  std::string admin_key;          // the file of the key that seals the fleet's orders
  std::string qos_file;           // what the fleet was started with
  std::string patient_readers;    // the file of that name's set; empty: no fault has it
  // The clock of every member, if the list steps clocks: each was started with its own.
  std::map<MemberId, SteppableClock> clocks;
  std::string attacker;       // the program of the intruder; empty: no such faults
  PrivateShm* shm = nullptr;  // null: no shared memory faults. Outlives the faults
};

// Sets a flag of a command line to a value, or adds it.
void SetFlag(std::vector<std::string>* words, const std::string& flag, const std::string& value);

class ProcessFaults {
 public:
  // `processes` outlives this. Use on the thread that created it.
  ProcessFaults(FaultTools tools, FleetProcesses* processes);

  // Null if this kind of fault can be injected into this target, else the reason.
  static const char* WhyNot(const faults::Fault& fault, bool has_discovery_servers);

  // Ignores faults of other actors. `fault` outlives its end. Throws StartError if a process that
  // it needs cannot be started.
  void Begin(const faults::Fault& fault);
  void End(const faults::Fault& fault);
  // Continues active faults: stops and resumes slow processes, polls its own children. Call often.
  // `time_s` since the start signal; 0 before it.
  void Turn(SteadyTime now, double time_s);

  // True while its process is gone as planned.
  bool IsAway(MemberId member) const {
    return away_.contains(member) || returning_.contains(member);
  }
  // The members that could not be started again as planned since the last call, and why: they wait
  // for the caller to do it.
  std::vector<FailedStart> TakeFailedStarts() { return std::exchange(failed_starts_, {}); }
  // The orders to take another profile set that ended since the last call.
  std::vector<QosOrders::Ended> TakeEndedOrders() { return orders_.TakeEnded(); }
  // True if the fault concerns this very process.
  bool IsAimedAt(const faults::Fault& fault, MemberId member) const;
  // How to start a member that has just ended: with the set of an active mismatch.
  MemberCommand CommandNow(MemberId member) const;
  // The visible effect of a fault: process stopped, gone, limited, refused. Empty if none is
  // visible, or if it is visible elsewhere.
  std::string EffectOf(const faults::Fault& fault) const;
  // The same of a fault that is about to end, as far as only all of it shows.
  std::string EffectAtEndOf(const faults::Fault& fault) const;
  // Of one that is about to end: why it had nothing to act on. Empty: it had, or that is not known.
  std::string WhyNothingMet(const faults::Fault& fault) const;
  // Those that are over, and whose effect can no longer come once this one starts.
  std::vector<const faults::Fault*> CutShortBy(const faults::Fault& fault);
  // The faults, by index in the schedule, whose effect the member's planned end is. Of a mismatch
  // it is only a means to another set.
  std::vector<std::size_t> KillersOf(MemberId member, const faults::Schedule& schedule) const;
  // Killed permanently.
  bool IsAwayForGood(MemberId member) const;

 private:
  struct Slow {
    DutyCycle duty;
    bool stopped = false;
  };
  // A soft limit as it was before a fault lowered it, of the process that had it.
  struct Lowered {
    pid_t pid = 0;
    std::uint64_t before = 0;
  };
  struct Churn {
    std::uint32_t left = 0;
    std::uint32_t killed = 0;  // of those that came, which ran until then
    std::unique_ptr<ChildProcess> process;
    SteadyTime until{0};
  };

  std::string EffectOn(const faults::Fault& fault, MemberId member) const;
  LogSeen LogOf(MemberId member) const;
  bool WorldAnswers() const;
  std::string ReadingsMoved(MemberId member) const;
  void BeginOfSharedMemory(const faults::Fault& fault);
  void EndOfSharedMemory(const faults::Fault& fault);
  void StepClock(MemberId member, double offset_s);
  void BeginOn(const faults::Fault& fault, MemberId member);
  void EndOn(const faults::Fault& fault, MemberId member);
  std::vector<MemberId> MembersOf(const faults::Target& target) const;
  const MemberCommand* CommandOf(MemberId member) const;
  std::unique_ptr<ChildProcess> StartBeside(MemberId member, std::uint32_t id,
                                            const std::string& name) const;
  void BeginOrders(const faults::Fault& fault);
  void StartAgain(MemberId member);
  void TurnSlow(MemberId member, SteadyTime now, Slow* slow);
  void TurnChurn(SteadyTime now, Churn* churn);
  void Lower(MemberId member, int resource, std::uint64_t most);
  void Restore(MemberId member, int resource);
  std::string LimitOf(MemberId member, int resource) const;

  FaultTools tools_;
  FleetProcesses* processes_;
  std::map<MemberId, const faults::Fault*> away_;
  std::set<MemberId> to_start_;   // killed at the start of a mismatch, to come back with its set
  std::set<MemberId> returning_;  // killed, to be restarted when the fault is over
  std::map<const faults::Fault*, std::string> shm_effects_;
  std::map<MemberId, Slow> slow_;
  std::map<std::pair<MemberId, int>, Lowered> lowered_;  // by resource
  std::map<MemberId, std::uint64_t> moved_before_;       // readings, before the clock's last step
  std::map<const faults::Fault*, Churn> churns_;
  QosOrders orders_;
  SecondClaims claims_;
  UnreadLogs unread_;
  std::uint32_t churned_ = 0;
  std::vector<FailedStart> failed_starts_;
  std::optional<SteadyTime> start_signal_;
};

}  // namespace giveway::fleetctl
