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
  VehicleId vehicle = kNoVehicle;  // kNoVehicle until a beacon was received
  WheelSpeeds wheels;              // never expires; 0 until a beacon was received
  SteadyTime received{0};
};

// Overwrites `last` with whatever came in last of all peers within the emission radius.
void HearTheLast(std::span<const Peer> peers, LastHeard* last);
// Adds nothing if no beacon was received: the other behaviours hash as if the variable did not
// exist.
void AddTo(const LastHeard& last, StateHash* hash);

}  // namespace giveway
