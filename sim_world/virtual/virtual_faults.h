// The faults of a schedule that a virtual run injects through its processes and its radio. The
// table of services/faults/kind_table.h says which kinds it knows: IncapableInVirtualTime. Values
// in, values out.
#pragma once

#include <cstdint>

#include "services/faults/fault.h"
#include "services/types/scenario.h"
#include "sim_world/virtual/virtual_plan.h"

namespace giveway::sim {

// The number by which a rule of the radio draws, one for each fault.
std::uint64_t DrawsOf(const faults::Fault& fault);

// The scenario's plan with the schedule's faults of processes and radio added; those of all
// vehicles become one for each. What a virtual run cannot inject is ignored: a caller refuses it,
// or reports that it is left out. Faults of the world stay in the schedule, which the run takes.
VirtualPlan Translated(const VirtualPlan& plan, const Scenario& scenario);

}  // namespace giveway::sim
