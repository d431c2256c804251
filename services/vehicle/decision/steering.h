// Which heading to take: towards the goal, or past a body that blocks the path and has published
// that it stays. Also the avoiding behaviours' wheel speeds. Pure.
#pragma once

#include "services/vehicle/situation/situation.h"

namespace giveway {

// With a larger heading error than this it turns on the spot before it drives.
inline constexpr double kTurnOnTheSpot_rad = 0.3;

struct Steering {
  double heading_error_rad = 0;       // wanted minus present heading, in (-pi, pi]
  VehicleId round = kNoVehicle;       // the halted peer that is being passed
  VehicleId blocked_by = kNoVehicle;  // without progress: the nearest on the straight path
  int side = 0;                       // turned away from the wanted heading: 1 left, -1 right
  std::optional<double> away_rad;     // the heading it keeps to from now on, if chosen just now
  bool gets_away = false;             // along such a heading, now or before: not to the goal
};

// Steers to the goal; where a standing peer that gives way blocks the straight path, along the
// tangent past it on the side nearer to the goal, its left when both are alike.
Steering SteerToGoal(const Situation& s);

// The highest speed at which the stopping path stays clear of every peer's claim, and of what the
// ultrasonics hear, if the vehicle turns as `steering` says; empty where the turn does not shorten
// the free path straight on. A turn is checked before it is made, as a speed is.
struct TurnLimit {
  double max_speed_m_s = 0;
  VehicleId peer = kNoVehicle;  // whose claim the turn leads to; kNoVehicle: to what was heard
  Tick cause_tick = kNoTick;
};
std::optional<TurnLimit> LimitOfTurn(const Steering& steering, const Situation& s);

// Braitenberg: wheel = base + sum of weight * activation (reference/lecture.md, behaviour A).
struct Avoidance {
  WheelSpeeds wheels;
  int sensor = -1;  // the most active one; -1 where none is
};
Avoidance Avoid(const BraitenbergWeights& weights, const RangeView& ranges);

// How fast it may drive forward, and whether it may turn where that is not at all.
struct Pace {
  double limit_m_s = 0;
  bool may_turn = true;
  double tick_s = 0;  // until the wheels are asked for something else
  // What it brakes for stands still straight ahead: it comes out of a turn first.
  bool straightens = false;
};

// Wheel speeds within a pace and for a steering, of a vehicle that moves as `now`: turns on the
// spot before it drives where the error is large. A turn makes no vehicle faster than its pace, of
// one that speeds up faster than it brakes either: that brakes first. One that may not turn stands
// dead still when its limit is 0. Both rims brake alike, so that it turns until it stands, unless
// it straightens: then the slower rim keeps its speed until the other is no faster.
WheelSpeeds Drive(const RobotModel& profile, const Twist& now, const Steering& steering,
                  const Pace& pace);

}  // namespace giveway
