// Which vehicles a schedule of faults silences, as the world must know: a process that is killed or
// stopped on purpose says nothing of the run, and one that comes back is taken back. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "services/faults/fault.h"
#include "services/types/ids.h"

namespace giveway::sim {

class PlannedSilence {
 public:
  explicit PlannedSilence(const faults::Schedule& schedule);

  // Whether anything but a kill is done to processes of vehicles: any of it may silence one for a
  // while. Then a closed run too continues without a vehicle that has fallen silent, and takes it
  // back when it speaks again.
  bool VehiclesReturn() const { return vehicles_return_; }
  // Whether the vehicle has been killed, never to come back, time_s after the start signal.
  bool IsKilled(VehicleId vehicle, double time_s) const;

 private:
  struct Kill {
    VehicleId vehicle = kNobody;  // kNobody: every one
    double at_s = 0;
  };

  bool vehicles_return_ = false;
  std::vector<Kill> kills_;
};

}  // namespace giveway::sim
