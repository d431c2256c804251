// Passive safety: where a peer can be until it stands, whatever it has decided since it was last
// heard, and how far the own vehicle may go without reaching into that. If everyone keeps out of
// everyone's claim, nobody touches, whoever is right, late or deaf. Pure geometry and kinematics.
//
// By induction: each vehicle drives on only where its own stopping way is clear of the claims of
// all others, grown for what is not yet known of them; otherwise it brakes, and a braking vehicle
// stays inside what it claimed before. Both rims brake alike, so that it keeps turning as it did
// until it stands: its stopping way is an arc, and the longer it takes to brake the more of one.
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

// No vehicle turns faster than this while it drives, whatever its wheels could do: a promise that
// every claim stands on, as steering.cc keeps it.
inline constexpr double kTurnWhileDriving_rad_s = 0.87;

// Which way the sender of a beacon is turned, a unit vector, and how fast it says it drives
// forward and turns: what follows from its heading and its wheels.
struct Course {
  Vec2 forward_world;
  double speed_m_s = 0;
  double turn_rad_s = 0;
};

// How far off its straight stopping way, at most and as a share of that way's length, a vehicle
// ends that turns at turn_rad_s for steady_s and until it stands, braking from speed_m_s. The
// lateral way of an arc: the integral of v(t) * turn * t, with v falling evenly a third of its
// length times the angle. Never above 1, for no arc leads farther than its length.
double SwingOf(double turn_rad_s, double steady_s, double speed_m_s, double deceleration_m_s2);

// How much longer the stopping way is of one that turns: when the inner rim stands the outer one
// still rolls, and the centre slows down half as fast. (turn * axle / 2)^2 / (2 * deceleration).
double TurnRollsOn(double turn_rad_s, double axle_m, double deceleration_m_s2);

// How far the sender of `beacon`, driving straight on at speed_m_s, may come before it stands.
double ClaimLength(const Beacon& beacon, double speed_m_s, double unknown_s, double reaction_s);

// True if the length of its claim is surely no more than length_m, however much of a second is
// unknown. Takes no division.
bool IsClaimShort(const Beacon& beacon, double speed_m_s, double reaction_s, double length_m);

// What the sender of `beacon` may cover from its pose until it stands, if it was free to do as it
// liked for `unknown_s` after the beacon and needs `reaction_s` before it brakes.
Claim ClaimOf(const Beacon& beacon, const Course& course, double unknown_s, double reaction_s);

// How far along `path` a disc of radius_m may go before it touches the claim; huge if it never
// does. From inside the claim: huge out of it and no nearer to the body it is of, 0 otherwise.
double FreeBefore(const Claim& claim, const Path& path, double radius_m);

}  // namespace giveway
