// What a picture of a run is drawn from: where each vehicle was seen.
#pragma once

#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/ids.h"

namespace giveway {

// What an observer saw of one vehicle, in order of ticks; gaps are possible.
struct Track {
  VehicleId vehicle = kNoVehicle;
  std::vector<Truth> truths;
};

}  // namespace giveway
