// From what a soak saw to its result: which promise was broken when, by whom and after which fault,
// and the verdict. Starts and measures nothing.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_result.h"
#include "services/fleetctl/soak/soak_session.h"
#include "services/fleetctl/stopwatch/stopwatch_table.h"

namespace giveway::fleetctl {

struct SoakEvidence {
  const SoakSession& session;
  const SoakSeen& seen;
  const faults::Schedule& schedule;
  SoakPhases phases;
  Limits limits;  // what the profile set promises
};

// A fault that peers must notice: its victim falls silent for longer than they may take.
bool MustBeNoticed(const faults::Fault& fault, Nanoseconds promised);

// Fills in faults, violations, near misses, histograms, slopes, pauses, verdict and reasons; what
// was run is in `result` already.
void Judge(const SoakEvidence& evidence, SoakResult* result);

}  // namespace giveway::fleetctl
