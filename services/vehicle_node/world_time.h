// In lockstep the only clock is the world's tick: a run repeats whatever the machine does, so
// nothing that depends on this machine's clock may come in.
#pragma once

#include <vector>

#include "services/types/vehicle_io.h"

namespace giveway {

class WorldTime {
 public:
  // Puts the world's time into the inputs, which then point into this until the next call. False if
  // there is no new tick: beacons are held until there is.
  bool Keep(Inputs* inputs, Nanoseconds tick_period);

 private:
  std::vector<ReceivedBeacon> held_;
  std::vector<ReceivedBeacon> now_;
};

}  // namespace giveway
