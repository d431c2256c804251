// Passive safety: where a peer can be until it stands, whatever it has decided since its last
// beacon, and how far this vehicle may drive without reaching into that. If every vehicle stays out
// of every other's claim, none touch, whichever has priority, is late or hears nothing. Pure
// geometry and kinematics.
//
// By induction: each vehicle drives on only where its own stopping path is clear of the claims of
// all others, grown by what is not yet known of them; otherwise it brakes, and a braking vehicle
// stays inside what it claimed before. Both rims brake alike, so that it keeps turning at the same
// rate until it stands: its stopping path is an arc, and the longer it brakes the more of one.
#pragma once

#include <algorithm>

#include "services/types/beacon.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/estimation/conflict.h"

namespace giveway {

// What is not known of a pose is allowed for by so many standard deviations.
inline constexpr double kSigmas = 2;

// A vehicle exceeds its published cruise speed only by slip and rounding.
inline constexpr double kCruiseSlack = 1.1;

// For how long a vehicle keeps clear of what a beacon claims. After a longer silence nothing can
// be said of a peer; the ultrasonics and PeerLost take over. Never shorter than a beacon counts as
// fresh: the age of a beacon starts a tick after it, and a decision moves the tick after its own.
inline Nanoseconds ClaimLasts(const VehicleOptions& options) {
  constexpr Nanoseconds kLeast{1'000'000'000};
  return std::max(kLeast, options.beacon_age_limit + 2 * options.tick_period);
}

// A stadium: all points within radius_m of the first length_m of the axis; a disc without length.
struct Claim {
  Path axis;
  double length_m = 0;
  double radius_m = 0;
};

// No vehicle turns faster than this while it drives, whatever its wheels could do: a promise that
// every claim stands on, as steering.cc keeps it. Not kept by the lecture's behaviours where they
// set the wheels themselves, avoiding or as printed: their claims may be too narrow.
inline constexpr double kTurnWhileDriving_rad_s = 0.87;

// The heading of a beacon's sender, a unit vector, and how fast it says it drives forward and
// turns: what follows from its heading and its wheels.
struct Course {
  Vec2 forward_world;
  double speed_m_s = 0;
  double turn_rad_s = 0;
};

// Lateral deviation from the straight stopping path, at most and as a share of that path's length,
// of a vehicle that turns at turn_rad_s for steady_s and until it stands, braking from speed_m_s.
// The lateral displacement of an arc: the integral of v(t) * turn * t, with v falling evenly a
// third of its length times the angle. To that comes kSigmas of the heading, which points the path
// elsewhere from its start. Never above 1, for no arc leads further than its length.
double SwingOf(double turn_rad_s, double steady_s, double speed_m_s, double deceleration_m_s2,
               const PoseCovariance& covariance);

// By how much turning lengthens the stopping path: when the inner rim stands the outer one still
// rolls, and the centre slows down half as fast. (turn * axle / 2)^2 / (2 * deceleration).
double TurnRollsOn(double turn_rad_s, double axle_m, double deceleration_m_s2);

// How far the sender of `beacon`, driving straight on at pace_m_s, forward or back, may come before
// it stands: it speeds up until it is at its fastest, keeps that up until unknown_s and its
// reaction are over, and brakes.
double ClaimLength(const Beacon& beacon, double pace_m_s, double unknown_s, double reaction_s);

// True if the length of its claim is surely no more than length_m, however much of lasts_s is
// unknown. Takes no division.
bool IsClaimShort(const Beacon& beacon, double speed_m_s, double lasts_s, double reaction_s,
                  double length_m);

// What the sender of `beacon` may cover from its pose until it stands, if it was free to do as it
// liked for `unknown_s` after the beacon and needs `reaction_s` before it brakes.
Claim ClaimOf(const Beacon& beacon, const Course& course, double unknown_s, double reaction_s);

// How far along `path` a disc of radius_m may go before it touches the claim; huge if it never
// does. From inside the claim: huge out of it and no nearer to the body it is of, 0 otherwise.
double FreeBefore(const Claim& claim, const Path& path, double radius_m);

}  // namespace giveway
