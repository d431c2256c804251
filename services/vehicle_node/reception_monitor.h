// Whether a vehicle can still hear its world and be heard, and what helps where it cannot.
#pragma once

#include <cstdint>

#include "services/link/drive_link.h"
#include "services/node/interface_check.h"
#include "services/vehicle_node/scan_watch.h"

namespace giveway {

enum class Remedy : std::uint8_t {
  kNone,
  kNewParticipant,  // the world speaks and is not heard, or newcomers cannot hear the vehicle,
                    // whose shared memory was deleted: it restarts itself
  kNewProcess,      // its interface is another now: it ends, for the restart policy
};

class ReceptionMonitor {
 public:
  ReceptionMonitor(link::DriveLink* link, SteadyTime now)
      : link_(*link), scans_(now), interface_([link] { return link->InterfaceChange(); }) {}

  // Once a turn; `scan`: one came; `settled`: no order is being carried out that a restart would
  // drop. Says in the log why, where there is a remedy.
  Remedy Update(SteadyTime now, bool scan, bool settled);

 private:
  link::DriveLink& link_;
  ScanWatch scans_;
  InterfaceCheck interface_;
};

}  // namespace giveway
