// What of a schedule of faults a virtual run carries out by its processes and its radio. Which
// kinds it knows is said by the table of services/faults/kind_table.h: IncapableInVirtualTime.
// Values in, values out.
#pragma once

#include "services/types/scenario.h"
#include "sim_world/virtual/virtual_plan.h"

namespace giveway::sim {

// The scenario's plan with the schedule's faults of processes and radio among its own: those of all
// are one for each vehicle. What a virtual run cannot carry out is passed over: a caller refuses
// it, or says that it is left out. Faults of the world stay in the schedule, which the run takes.
VirtualPlan Translated(const VirtualPlan& plan, const Scenario& scenario);

}  // namespace giveway::sim
