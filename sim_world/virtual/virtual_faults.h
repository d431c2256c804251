// What of a schedule of faults a virtual run carries out, and by what: its processes, its radio,
// its world. Values in, values out.
#pragma once

#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/types/scenario.h"
#include "sim_world/virtual/virtual_plan.h"

namespace giveway::sim {

// Why a virtual run cannot carry the fault out; empty where it can. A caller refuses such a fault,
// or leaves it out; RunVirtually passes over it.
std::string WhyNotVirtual(const faults::Fault& fault);

// The scenario's plan with the schedule's faults of processes and radio among its own. Faults of
// the world stay in the schedule, which the run takes; those of all are one for each vehicle.
VirtualPlan Translated(const VirtualPlan& plan, const Scenario& scenario);

}  // namespace giveway::sim
