// Passive safety: where a peer can be until it stands, whatever it has decided since it was last
// heard, and how far the own vehicle may go without reaching into that. If everyone keeps out of
// everyone's claim, nobody touches, whoever is right, late or deaf. Pure geometry and kinematics.
//
// By induction: each vehicle drives on only where its own stopping way is clear of the claims of
// all others, grown for what is not yet known of them; otherwise it brakes, and a braking vehicle
// stays inside what it claimed before.
#pragma once

#include "services/types/beacon.h"
#include "services/vehicle/estimation/conflict.h"

namespace giveway {

// A stadium: all points within radius_m of the first length_m of the axis.
struct Claim {
  Path axis;
  double length_m = 0;
  double radius_m = 0;
};

// Which way the sender of a beacon is turned, a unit vector, and how fast it says it drives
// forward: what follows from its heading and its wheels.
struct Course {
  Vec2 forward_world;
  double speed_m_s = 0;
};

// How far the sender of `beacon`, driving at speed_m_s, may come before it stands: see ClaimOf.
double ClaimLength(const Beacon& beacon, double speed_m_s, double unknown_s, double reaction_s);

// True if ClaimLength is surely no more than length_m, however much of a second is unknown. Takes
// no division.
bool IsClaimShort(const Beacon& beacon, double speed_m_s, double reaction_s, double length_m);

// What the sender of `beacon` may cover from its pose until it stands, if it was free to do as it
// liked for `unknown_s` after the beacon and needs `reaction_s` before it brakes.
Claim ClaimOf(const Beacon& beacon, const Course& course, double unknown_s, double reaction_s);

// How far along `path` a disc of radius_m may go before it touches the claim; huge if it never
// does. From inside the claim: 0 deeper into it, huge out of it.
double FreeBefore(const Claim& claim, const Path& path, double radius_m);

}  // namespace giveway
