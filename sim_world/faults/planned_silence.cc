#include "sim_world/faults/planned_silence.h"

#include <algorithm>

namespace giveway::sim {

PlannedSilence::PlannedSilence(const faults::Schedule& schedule) {
  using What = faults::Target::What;
  for (const faults::Fault& fault : schedule) {
    if (faults::ActorOf(fault.kind) != faults::Actor::kSupervisor) continue;
    const bool of_vehicles = fault.target.what == What::kVehicle || fault.target.what == What::kAll;
    if (!of_vehicles) continue;
    if (fault.kind == faults::Kind::kKill) {
      kills_.push_back(
          {fault.target.what == What::kAll ? kNoVehicle : fault.target.vehicle, fault.at_s});
    } else {
      vehicles_return_ = true;
    }
  }
}

bool PlannedSilence::IsKilled(VehicleId vehicle, double time_s) const {
  return std::ranges::any_of(kills_, [&](const Kill& kill) {
    return (kill.vehicle == kNoVehicle || kill.vehicle == vehicle) && kill.at_s <= time_s;
  });
}

}  // namespace giveway::sim
