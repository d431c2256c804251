// From what a soak saw to its result: which promise was broken when, by which vehicle and after
// which fault, and the verdict. Starts and measures nothing. Pure.
#pragma once

#include <functional>
#include <vector>

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
  bool by_processes = true;  // else nothing is known of what the middleware reported
};

// What must report a fault to peers, and within what time: its target falls silent for longer. Not
// the age of beacons, which is of those that are near, and not the lease, which outlasts most
// faults.
struct Expected {
  Mechanism mechanism = Mechanism::kDeadline;
  Nanoseconds within{0};
};
std::vector<Expected> ExpectedOf(const faults::Fault& fault, const Limits& limits);

// Fills in faults, violations, near misses, histograms, slopes, pauses, verdict and reasons; what
// was run is in `result` already.
void Judge(const SoakEvidence& evidence, SoakResult* result);

}  // namespace giveway::fleetctl
