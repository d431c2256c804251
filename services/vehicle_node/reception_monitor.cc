#include "services/vehicle_node/reception_monitor.h"

#include "services/node/service_run.h"
#include "services/runtime/process.h"

namespace giveway {
namespace {

// Silence does not prove a changed interface, but without silence there is no need to check.
constexpr Nanoseconds kSilence = std::chrono::seconds(2);
constexpr Nanoseconds kCheckEvery = std::chrono::seconds(1);

}  // namespace

Remedy ReceptionMonitor::Update(SteadyTime now, bool scan, bool settled) {
  if (scan) last_scan_ = now;
  if (scans_.Update(now, scan, link_.WorldSpeaks())) {
    LogError("the world speaks, but its scans do not arrive: starts itself again to hear it");
    return Remedy::kNewParticipant;
  }
  if (settled && link_.SharedMemoryIsGone()) {
    LogError(kSharedMemoryDeleted);
    return Remedy::kNewParticipant;
  }
  if (now - last_scan_ < kSilence || now < next_check_) return Remedy::kNone;
  next_check_ = now + kCheckEvery;
  const std::string change = link_.InterfaceChange();
  if (change.empty()) return Remedy::kNone;
  LogError(change + "; ends, to be started again");
  return Remedy::kNewProcess;
}

}  // namespace giveway
