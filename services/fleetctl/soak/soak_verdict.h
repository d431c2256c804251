// From the observations of a soak to its result: which promise was broken when, by which vehicle
// and after which fault, and the verdict. Starts and measures nothing. Pure.
#pragma once

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
  Limits limits;                 // the promises of the profile set
  bool by_processes = true;      // else nothing is known of events of the middleware
  std::vector<VehicleId> fleet;  // who may notice that a peer falls silent; empty: any
};

// What must report a fault to peers, and within what time: its target falls silent for longer. Not
// the age of beacons, which applies only to near peers, and not the lease, which outlasts most
// faults.
struct Expected {
  Mechanism mechanism = Mechanism::kDeadline;
  Nanoseconds within{0};
};
std::vector<Expected> ExpectedOf(const faults::Fault& fault, const Limits& limits);
// When at the latest, without a pause of the machine, it must have been reported.
SteadyTime LatestReport(SteadyTime began, const Expected& expected);

// Fills in faults, violations, near misses, histograms, slopes, pauses, verdict and reasons;
// `result` already has what was run.
void EvaluateSoak(const SoakEvidence& evidence, SoakResult* result);

}  // namespace giveway::fleetctl
