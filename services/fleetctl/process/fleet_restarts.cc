#include "services/fleetctl/process/fleet_restarts.h"

#include <algorithm>

namespace giveway::fleetctl {

bool FleetRestarts::AwaitsAny(const std::function<bool(MemberId)>& of) const {
  return std::ranges::any_of(due_, [&of](const auto& entry) { return of(entry.first); });
}

std::vector<FailedStart> FleetRestarts::Turn(
    SteadyTime now, const std::function<MemberCommand(MemberId)>& command_of) {
  std::vector<FailedStart> failed;
  std::erase_if(due_, [&](const auto& entry) {
    const auto& [member, at] = entry;
    if (now < at) return false;
    try {
      if (!processes_->IsRunning(member)) processes_->Restart(command_of(member));
    } catch (const StartError& error) {
      failed.push_back({member, error.what()});
    }
    return true;
  });
  for (const FailedStart& start : failed) NoteEnd(start.member, now);
  return failed;
}

}  // namespace giveway::fleetctl
