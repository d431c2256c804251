// What a fixed-time plan shows when, and whether two of them ever let traffic go at once. Exact:
// durations are whole nanoseconds.
#pragma once

#include "services/types/scenario.h"
#include "services/types/signal.h"
#include "services/types/time.h"

namespace giveway {

struct PlannedPhase {
  SignalPhase phase = SignalPhase::kRed;
  Nanoseconds to_change{0};  // positive; a plan with one phase alone changes to the same again
};

// `since_start` may be negative: the plan has always been running. Its durations are not negative
// and not all 0.
PlannedPhase PhaseAt(const SignalPlan& plan, Nanoseconds since_start);

// True if at some time, sooner or later, both are green or yellow: heads of one group must not be.
bool ShowGreenTogether(const SignalPlan& a, const SignalPlan& b);

}  // namespace giveway
