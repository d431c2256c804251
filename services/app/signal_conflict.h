// Whether two fixed-time plans let conflicting traffic go at one time.
#pragma once

#include "services/types/scenario.h"

namespace giveway::app {

// True if there is a moment, however late, at which neither head is red. Times are compared to the
// nanosecond; an end that meets a beginning is no such moment. Cycles of lengths that do not fit
// each other drift, and so meet sooner or later.
bool GoTogether(const SignalPlan& a, const SignalPlan& b);

}  // namespace giveway::app
