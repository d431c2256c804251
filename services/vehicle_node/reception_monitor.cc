#include "services/vehicle_node/reception_monitor.h"

#include "services/node/service_run.h"
#include "services/runtime/process.h"

namespace giveway {

Remedy ReceptionMonitor::Update(SteadyTime now, bool scan, bool settled) {
  if (scans_.Update(now, scan, link_.WorldSpeaks())) {
    LogError("the world speaks, but its scans do not arrive: starts itself again to hear it");
    return Remedy::kNewParticipant;
  }
  if (settled && link_.SharedMemoryIsGone()) {
    LogError(kSharedMemoryDeleted);
    return Remedy::kNewParticipant;
  }
  return interface_.MustEnd(now, scan) ? Remedy::kNewProcess : Remedy::kNone;
}

}  // namespace giveway
