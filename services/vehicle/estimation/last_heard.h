// What the lecture's printed scripts know of the others: one variable for the vehicle that spoke
// last. Only lecture_printed reads it; it overwrites every other neighbour, as printed.
#pragma once

#include <span>

#include "services/types/beacon.h"
#include "services/types/state_hash.h"
#include "services/vehicle/estimation/peer_table.h"

namespace giveway {

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

}  // namespace giveway
