// The lecture's yielding scripts as printed, flaws included: one variable for whoever spoke last,
// any echo taken for that peer, the speeds of this moment compared, and in the branch that should
// halt the peer's speed copied. It collides; it is there to show what the other behaviours settle
// (tests/golden/lecture_printed_test.cc). Never a default.
#pragma once

#include <span>

#include "services/types/beacon.h"
#include "services/types/state_hash.h"

namespace giveway {

struct Action;
struct Peer;
struct Situation;

// The script's one variable for "the near robot".
struct LastHeard {
  VehicleId vehicle = kNobody;  // kNobody until anybody was heard
  WheelSpeeds wheels;           // believed for ever; 0 until anybody was heard
  SteadyTime received{0};
};

// Overwrites `last` with whatever came in last of all peers within the emission radius.
void HearTheLast(std::span<const Peer> peers, LastHeard* last);
// Nothing where nobody was heard: the other behaviours hash as if there were no such variable.
void AddTo(const LastHeard& last, StateHash* hash);

// `wanted` as long as nothing echoes within the gate, or this vehicle is the faster one; else the
// speeds of whoever was heard last.
Action AsPrinted(const Situation& s, const Action& wanted);

}  // namespace giveway
