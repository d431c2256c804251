// The lecture's yielding scripts as printed, flaws included: one variable for the last sender, any
// echo taken for that peer, momentary speeds compared, and the peer's speed copied in the branch
// that should halt. It collides; it is there to show what the other behaviours settle
// (tests/golden/lecture_printed_test.cc). Never a default.
#pragma once

#include "services/vehicle/decision/action.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// `wanted` while nothing echoes within the gate, or this vehicle is the faster one; otherwise the
// wheel speeds of the peer heard last.
Action AsPrinted(const Situation& s, const Action& wanted);

}  // namespace giveway
