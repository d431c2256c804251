// Which vehicles a fault schedule silences, as far as the world needs to know: it does not count a
// process that is killed or stopped on purpose against the run, and takes back one that returns.
// Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "services/faults/fault.h"
#include "services/types/ids.h"

namespace giveway::sim {

class PlannedSilence {
 public:
  explicit PlannedSilence(const faults::Schedule& schedule);

  // Whether processes of vehicles have any fault other than a kill: each may silence a vehicle for
  // a while. Then a closed run too continues without a vehicle that has fallen silent, and takes it
  // back when it is heard again.
  bool VehiclesReturn() const { return vehicles_return_; }
  // Whether the vehicle was killed permanently by time_s after the start signal.
  bool IsKilled(VehicleId vehicle, double time_s) const;

 private:
  struct Kill {
    VehicleId vehicle = kNoVehicle;  // kNoVehicle: every vehicle
    double at_s = 0;
  };

  bool vehicles_return_ = false;
  std::vector<Kill> kills_;
};

}  // namespace giveway::sim
