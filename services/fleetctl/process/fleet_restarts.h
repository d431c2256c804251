// Starts the processes of a fleet again that ended by themselves, as a container's restart policy
// does: after a wait that grows. One that cannot be started waits like one that ended at once.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "services/fleetctl/process/fleet_processes.h"
#include "services/fleetctl/process/restart_backoff.h"

namespace giveway::fleetctl {

struct FailedStart {
  MemberId member;
  std::string why;
};

class FleetRestarts {
 public:
  // `processes` outlives this.
  explicit FleetRestarts(FleetProcesses* processes) : processes_(processes) {}

  // It ended, or could not be started.
  void NoteEnd(MemberId member, SteadyTime now) { due_[member] = backoff_.StartOf(member, now); }
  // Whether it, or any of these, is still to be started.
  bool Awaits(MemberId member) const { return due_.contains(member); }
  bool AwaitsAny(const std::function<bool(MemberId)>& of) const;
  // Starts those that are due and do not run. Returns the ones that could not be: they are due
  // later.
  std::vector<FailedStart> Turn(SteadyTime now,
                                const std::function<MemberCommand(MemberId)>& command_of);

 private:
  FleetProcesses* processes_;
  RestartBackoff backoff_;
  std::map<MemberId, SteadyTime> due_;
};

}  // namespace giveway::fleetctl
