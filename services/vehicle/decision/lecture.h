// The lecture's yielding scripts as printed, flaws included: one variable for whoever spoke last,
// any echo taken for that peer, the speeds of this moment compared, and in the branch that should
// halt the peer's speed copied. It collides; it is there to show what the other behaviours settle
// (tests/golden/lecture_printed_test.cc). Never a default.
#pragma once

#include "services/vehicle/decision/action.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// `wanted` as long as nothing echoes within the gate, or this vehicle is the faster one; else the
// speeds of whoever was heard last.
Action AsPrinted(const Situation& s, const Action& wanted);

}  // namespace giveway
