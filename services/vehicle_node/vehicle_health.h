// What a vehicle's loop reports of its health, and when.
#pragma once

#include <string>

#include "services/health/health_service.h"
#include "services/link/drive_link.h"
#include "services/vehicle/vehicle.h"

namespace giveway {

class VehicleHealthReporter {
 public:
  explicit VehicleHealthReporter(const ServiceFlags& flags) : service_(flags) {}

  // It has no participant yet, and `waits_for` says why; empty: it makes one now.
  void OnStarting(const std::string& waits_for);
  // It asks for a place; `waits_for` is what the world said last, empty if nothing.
  void OnJoining(const std::string& waits_for);
  // It was given a place as vehicle `id`, and will drive with ranges no older than that.
  void OnPlaced(VehicleId id, Nanoseconds ranges_age_limit);
  // The loop has taken what came, at `woke`.
  void OnTick(const link::Taken& taken, const link::VehicleLinkCounters& counters,
              const RosterEntry& place, SteadyTime woke);
  // This status was published to the fleet; `brain` is the state it was made from.
  void OnStatus(const VehicleStatus& status, const VehicleState& brain);
  void OnLeaving();
  const VehicleHealth& Reported() const { return service_.Now(); }

 private:
  HealthService<VehicleHealth> service_;
};

}  // namespace giveway
