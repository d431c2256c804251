// Who can arrive, said before the run by geometry alone: two bodies that touch if both stand on
// their goals cannot both, and of those who share a goal in that way one can.
#pragma once

#include <vector>

#include "services/types/scenario.h"

namespace giveway::sim {

struct Arriving {
  std::vector<VehicleId> each;                 // ascending: everyone of these
  std::vector<std::vector<VehicleId>> one_of;  // one of each group, ascending within it
};

// Of the vehicles that have a goal; not of those that join an open fleet.
Arriving WhoCanArrive(const Scenario& scenario);

}  // namespace giveway::sim
