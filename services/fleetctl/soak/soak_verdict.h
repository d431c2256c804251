// From what a soak saw to its result: which promise was broken when, by whom and after which fault,
// and the verdict. Starts and measures nothing. Pure.
#pragma once

#include <functional>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/soak_result.h"
#include "services/fleetctl/soak/soak_seen.h"
#include "services/fleetctl/stopwatch/stopwatch_table.h"

namespace giveway::fleetctl {

struct SoakEvidence {
  const SoakSeen& seen;
  const faults::Schedule& schedule;
  Limits limits;  // what the profile set promises
  // The longest time that the machine stood still between two moments of the run.
  std::function<Nanoseconds(SteadyTime, SteadyTime)> longest_pause;
};

// A fault that peers must notice: its victim falls silent for longer than they may take.
bool MustBeNoticed(const faults::Fault& fault, Nanoseconds promised);

// Fills in faults, violations, near misses, histograms, slopes, pauses, verdict and reasons; what
// was run is in `result` already.
void Judge(const SoakEvidence& evidence, SoakResult* result);

}  // namespace giveway::fleetctl
