#include "services/vehicle/decision/steering.h"

#include <algorithm>
#include <array>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/situation/claim.h"
#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/situation/heard_places.h"
#include "services/vehicle/situation/peer_relation.h"

namespace giveway {
namespace {

// Closer to a body than the passing distance, every heading that does not lead closer is free:
// between two bodies no heading would be free otherwise.
constexpr double kBesideIt_rad = kPi / 2 - 0.03;
// Obstacles up to this far ahead are steered round.
constexpr double kLookahead_m = 3;
// A heading on the side of the last turn is kept although another is this much nearer.
constexpr double kKeepSide_rad = 0.6;
// Past an obstacle, but not back: a vehicle that turns round in a lane meets its followers head-on.
constexpr double kNoReturn_rad = 1.8;
// A turn by less than this is none, and a gap no wider.
constexpr double kSmall_rad = 0.02;
// So near to where something would stop it, it comes no further.
constexpr double kCreeps_m = 0.05;

// An obstacle as seen from the axle centre: no heading between `middle` - `half` and `middle` +
// `half` gets past it.
struct Blocked {
  double middle_rad;
  double half_rad;
  double distance_m;
  VehicleId peer;
};

struct BlockedHeadings {
  std::array<Blocked, 64> of;  // the first `count`
  std::size_t count = 0;
  bool echoes = false;  // some of them are
  bool stops = false;   // one of these keeps the vehicle where it stands
};

// Stands ahead on the same path and will resume: this vehicle queues behind it. Overtaking a queue
// ends in front of oncoming traffic.
bool Queues(const PeerView& view, const Situation& s) {
  if (MutantActive(Mutant::kQueueOvertaken)) return false;
  if (StaysPut(view.peer->beacon.rule)) return false;
  constexpr double kSameDirection = 0.87;  // the cosine of 30 degrees
  const double path_m = Norm(view.path_world);
  return path_m > 0.5 && view.fresh &&
         Dot(view.path_world, s.own.path.direction_world) > kSameDirection * path_m;
}

// True for a peer to steer round: one that stands. A peer that has priority and could start at any
// time is handled by right of way as long as its beacon says that it will resume.
bool StandsInPath(const PeerView& view, const Situation& s) {
  if (s.own.options.behaviour != Behaviour::kCooperative) {
    return view.fresh && view.standing && view.grants && !view.has_priority;
  }
  if (!view.standing || view.peer->left || MutantActive(Mutant::kSteersRoundNobody)) return false;
  // One that stands only because of a third vehicle resumes with it.
  const bool held_up = view.fresh && view.peer->beacon.rule == Rule::kKeepClear;
  if (held_up && !s.escape.no_progress) return false;
  return !Queues(view, s) || (s.escape.long_no_progress && !view.at_signal);
}

// Headings past which nothing gets within `path_m`.
BlockedHeadings WhatBlocks(const Situation& s, double path_m) {
  BlockedHeadings headings;
  // A peer standing on the goal itself is waited for: no path round it reaches the goal. Unless
  // this vehicle stands on the peer's goal, and not for ever: three can block each other in a ring.
  const Vec2 target =
      s.own.world_from_body.position_world + s.own.distance_to_goal_m * s.own.path.direction_world;
  for (const PeerView& view : s.near.peers) {
    if (!StandsInPath(view, s) || headings.count == headings.of.size()) continue;
    const bool waited_for =
        !s.escape.no_progress && Occupies(view, target, s.own) && !IsOnGoalOf(view, s.own);
    if (waited_for) continue;
    const double distance_m = view.distance_m;
    const double clearance_m = RoomBeside(view, s.own);
    if (distance_m - clearance_m > path_m) continue;
    const double half_rad =
        distance_m > clearance_m
            ? Atan2(clearance_m, Sqrt(distance_m * distance_m - clearance_m * clearance_m))
            : kBesideIt_rad;
    headings.of[headings.count++] = {Atan2(view.offset_world.y, view.offset_world.x), half_rad,
                                     distance_m, view.peer->id};
  }
  return headings;
}

// Echoes near that no beacon explains. Only for a vehicle that makes no progress: the bearing of an
// echo within its cone is unknown, and blocking the whole cone takes more than the obstacle does.
void AddEchoes(const Situation& s, BlockedHeadings* headings) {
  constexpr double kNear_m = 0.6;         // from the transducer
  constexpr double kHalf_rad = 0.6;       // more than a cone: the body has a width too
  constexpr double kTurnAway_rad = 0.15;  // at a time, from what stops the vehicle as it stands
  const RobotModel& profile = s.own.options.profile;
  for (const std::size_t i : BitsOf(s.own.ranges.Echoes() & ~s.near.explained)) {
    const SensorView& view = s.own.ranges[i];
    if (view.range_m > kNear_m || headings->count == headings->of.size()) continue;
    const double bearing_rad = profile.sonar[i].bearing_rad;
    const std::optional<double> free_m = FreeAhead(i, s);
    const bool stops = free_m && *free_m <= kStandOff_m + kCreeps_m;
    headings->echoes = true;
    headings->stops = headings->stops || stops;
    headings->of[headings->count++] = {
        WrapAngle(s.own.world_from_body.heading_rad + bearing_rad),
        std::max(kHalf_rad, stops ? Magnitude(bearing_rad) + kTurnAway_rad : 0), view.range_m,
        kNoVehicle};
  }
}

// The same of places where something was heard: from its middle to where the shell gets past. The
// nearest in each direction.
void AddPlaces(const Situation& s, BlockedHeadings* headings) {
  constexpr double kNear_m = 0.5;          // from the own shell
  constexpr double kPasses_m = 0.08;       // between the shell and the middle of a cell
  constexpr std::size_t kDirections = 32;  // of 11 degrees: half of what fits in BlockedHeadings
  const double room_m = s.own.options.profile.body_radius_m + kPasses_m;
  std::array<const Vec2*, kDirections> nearest{};
  for (const Vec2& place : s.places) {
    if (SquaredNorm(place) > (room_m + kNear_m) * (room_m + kNear_m)) continue;
    const double share = (Atan2(place.y, place.x) + kPi) / (2 * kPi) * kDirections;
    const std::size_t i = std::min(static_cast<std::size_t>(share), kDirections - 1);
    if (nearest[i] == nullptr || SquaredNorm(place) < SquaredNorm(*nearest[i])) nearest[i] = &place;
  }
  const std::optional<double> free_m = FreeOfPlaces({1, 0}, s);
  headings->stops = headings->stops || (free_m && *free_m <= kStandOff_m + kCreeps_m);
  for (const Vec2* place : nearest) {
    if (place == nullptr || headings->count == headings->of.size()) continue;
    const double distance_m = Norm(*place);
    const double half_rad = distance_m > room_m
                                ? Atan2(room_m, Sqrt(distance_m * distance_m - room_m * room_m))
                                : kBesideIt_rad;
    headings->echoes = true;
    headings->of[headings->count++] = {
        WrapAngle(s.own.world_from_body.heading_rad + Atan2(place->y, place->x)), half_rad,
        distance_m, kNoVehicle};
  }
}

// The nearest of what blocks a heading, or of the vehicles among it.
const Blocked* BlockedAt(const BlockedHeadings& headings, double heading_rad,
                         bool vehicles_alone = false) {
  const Blocked* nearest = nullptr;
  for (std::size_t i = 0; i < headings.count; ++i) {
    const Blocked& blocked = headings.of[i];
    const double off_rad = Magnitude(WrapAngle(heading_rad - blocked.middle_rad));
    if (!(off_rad < blocked.half_rad - 1e-6)) continue;
    if (vehicles_alone && blocked.peer == kNoVehicle) continue;
    if (nearest == nullptr || blocked.distance_m < nearest->distance_m) nearest = &blocked;
  }
  return nearest;
}

// The nearest vehicle on the straight path to the goal.
VehicleId OnStraightPath(const BlockedHeadings& headings, const Situation& s) {
  const Blocked* vehicle = BlockedAt(headings, s.own.path_rad, true);
  return vehicle == nullptr ? kNoVehicle : vehicle->peer;
}

// The wanted heading if it is free, or the nearest that is, along an edge of something; the side of
// the last turn is kept unless the other is much nearer. Empty where none is free.
std::optional<double> FreeHeading(const BlockedHeadings& headings, double wanted_rad, int side,
                                  bool vehicles_alone) {
  if (BlockedAt(headings, wanted_rad, vehicles_alone) == nullptr) return wanted_rad;
  std::optional<double> best;
  double best_cost = 1e9;
  for (std::size_t i = 0; i < headings.count; ++i) {
    const Blocked& blocked = headings.of[i];
    if (vehicles_alone && blocked.peer == kNoVehicle) continue;
    for (const int end : {1, -1}) {
      const double edge = blocked.middle_rad + end * blocked.half_rad;
      if (BlockedAt(headings, edge, vehicles_alone) != nullptr) continue;
      if (BlockedAt(headings, edge + end * kSmall_rad, vehicles_alone) != nullptr) continue;
      const double turn = WrapAngle(edge - wanted_rad);
      if (Magnitude(turn) > kNoReturn_rad) continue;
      // Passing on the right, with the obstacle to the left, where both sides are alike.
      const bool other_side = side == 0 ? turn > 0 : turn * side < 0;
      const double cost = Magnitude(turn) + (other_side ? (side == 0 ? 0.05 : kKeepSide_rad) : 0);
      if (cost >= best_cost) continue;
      best = edge;
      best_cost = cost;
    }
  }
  return best;
}

// For a stuck vehicle: a heading along which no claim is near; empty if none of those tried is.
// Each is turned by the golden angle from the one before, so that a few attempts cover the full
// circle, however narrow the exit, and none is tried twice.
std::optional<double> EscapeHeading(double wanted_rad, const Situation& s) {
  constexpr double kGoldenAngle_rad = 2.399963229728653;  // pi * (3 - sqrt(5))
  constexpr int kHeadings = 24;   // so many by the golden angle leave gaps of 20 degrees at most
  constexpr double kOut_m = 0.1;  // less is not worth a turn
  for (int i = 0; i < kHeadings; ++i) {
    const double heading_rad =
        WrapAngle(wanted_rad + (s.escape.escape_attempts + i) * kGoldenAngle_rad);
    const Vec2 forward_world = {Cos(heading_rad), Sin(heading_rad)};
    const bool leads_out = std::ranges::all_of(s.near.peers, [&](const PeerView& view) {
      return FreeAlong(view, forward_world, s.own) >= kOut_m;
    });
    if (leads_out) return heading_rad;
  }
  return std::nullopt;
}

// Where to turn, and whether that is kept to for a while.
struct Turn {
  double heading_rad;
  bool kept;
};

// Past vehicles and echoes, or past the vehicles where that leaves no heading: an echo takes more
// than what it is of, and the rules still stop before that. The wanted one where they leave none
// either. Kept is what echoes decide, for they turn with the vehicle: halfway to a heading another
// one may look better, and it would turn to and fro for ever.
Turn TurnPast(const BlockedHeadings& headings, double wanted_rad, int side) {
  const auto past_all = FreeHeading(headings, wanted_rad, side, false);
  const auto past_vehicles =
      headings.echoes ? FreeHeading(headings, wanted_rad, side, true) : past_all;
  if (past_all) return {*past_all, past_all != past_vehicles};
  return {past_vehicles.value_or(wanted_rad), false};
}

// With others near and ahead it lets them clear the space: turning away in front of them would
// block more of them.
bool HasCompany(const Situation& s) {
  constexpr double kNear_m = 1;  // shell to shell
  return std::ranges::any_of(s.near.peers, [&s](const PeerView& view) {
    return view.gap_m < kNear_m && !view.peer->left &&
           Dot(view.offset_world, s.own.path.direction_world) > 0;
  });
}

// The heading it chose recently and keeps to. Once it has turned there and is stopped again, it
// looks for another.
std::optional<double> KeptHeading(const BlockedHeadings& headings, const Situation& s) {
  constexpr double kTurned_rad = 0.1;
  if (!s.escape.away_rad) return std::nullopt;
  const double error_rad = WrapAngle(*s.escape.away_rad - s.own.world_from_body.heading_rad);
  const bool stopped_there = headings.stops && Magnitude(error_rad) <= kTurned_rad;
  return stopped_there ? std::nullopt : s.escape.away_rad;
}

double Activation(const BraitenbergWeights& weights, const SensorView& view) {
  if (view.kind != Echo::kEcho || view.range_m >= weights.far_gate_m) return 0;
  const double range = std::max(view.range_m, weights.near_gate_m);
  return 1 - (range - weights.near_gate_m) / (weights.far_gate_m - weights.near_gate_m);
}

}  // namespace

Steering SteerToGoal(const Situation& s) {
  Steering steering;
  double wanted = s.own.path_rad;
  double path_m = std::min(s.own.distance_to_goal_m, kLookahead_m);
  if (s.escape.detour_world) {
    const Vec2 displacement = *s.escape.detour_world - s.own.world_from_body.position_world;
    wanted = Atan2(displacement.y, displacement.x);
    path_m = Norm(displacement);
  }
  BlockedHeadings headings = WhatBlocks(s, path_m);
  if (s.escape.no_progress) {
    AddEchoes(s, &headings);
    AddPlaces(s, &headings);
    steering.blocked_by = OnStraightPath(headings, s);
  }
  if (s.escape.escape_attempts >= 0 && !s.escape.away_rad)
    steering.away_rad = EscapeHeading(wanted, s);
  if (const auto kept = steering.away_rad ? steering.away_rad : KeptHeading(headings, s)) {
    steering.side = s.own.steer_side;
    steering.gets_away = true;
    steering.heading_error_rad = WrapAngle(*kept - s.own.world_from_body.heading_rad);
    return steering;
  }
  if (const Blocked* blocked = BlockedAt(headings, wanted)) {
    const Turn turn = TurnPast(headings, wanted, s.own.steer_side);
    const double heading = turn.heading_rad;
    steering.round = blocked->peer;
    steering.side = WrapAngle(heading - wanted) > 0 ? 1 : -1;
    steering.heading_error_rad = WrapAngle(heading - s.own.world_from_body.heading_rad);
    const bool gets_away = headings.stops && !HasCompany(s);
    const bool turns_on_the_spot = s.own.speed_m_s < kStandingSpeed_m_s &&
                                   Magnitude(steering.heading_error_rad) > kTurnOnTheSpot_rad;
    if (heading != wanted && (gets_away || (turn.kept && turns_on_the_spot))) {
      steering.away_rad = heading;
      steering.gets_away = true;
    }
    return steering;
  }
  steering.heading_error_rad = WrapAngle(wanted - s.own.world_from_body.heading_rad);
  return steering;
}

Avoidance Avoid(const BraitenbergWeights& weights, const RangeView& ranges) {
  Avoidance avoidance{.wheels = {weights.base_rad_s, weights.base_rad_s}};
  double strongest = 0;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const double activation = Activation(weights, ranges[i]);
    avoidance.wheels.left_rad_s += weights.left[i] * activation;
    avoidance.wheels.right_rad_s += weights.right[i] * activation;
    if (activation > strongest) {
      strongest = activation;
      avoidance.sensor = static_cast<int>(i);
    }
  }
  return avoidance;
}

namespace {

// Both rims speed up no faster than the drive allows. Turning comes first: asked for all of both, a
// vehicle that speeds up keeps the turn it has, and sways from side to side.
double SpeedBesideTurn(const RobotModel& profile, const Twist& now, double turn_rad_s,
                       double speed_m_s) {
  constexpr double kAhead_s = 0.25;  // what both rims may gain within: five ticks of 50 ms
  constexpr double kNoTurn_m_s = 0.005;
  const double rim_m_s = profile.drive.axle_m / 2 * Magnitude(turn_rad_s - now.turn_rad_s);
  if (rim_m_s < kNoTurn_m_s) return speed_m_s;
  const double more_m_s = std::max(0.0, kAhead_s * profile.acceleration_m_s2 - rim_m_s);
  return std::min(speed_m_s, std::max(0.0, now.forward_m_s) + more_m_s);
}

// When a vehicle drives off while it turns on the spot, the rim that rolls back has to brake first,
// which may take long. The other rim would outrun it, and the vehicle would turn faster than peers
// assume.
double SpeedWithinTurn(const RobotModel& profile, const Twist& now, double turn_rad_s,
                       double most_rad_s) {
  const double axle_m = profile.drive.axle_m;
  const double turn_now_rad_s = turn_rad_s < 0 ? -now.turn_rad_s : now.turn_rad_s;
  const double inner_m_s = now.forward_m_s - axle_m / 2 * turn_now_rad_s;
  if (inner_m_s >= 0) return profile.max_speed_m_s;
  return std::max(0.0, inner_m_s + axle_m * (most_rad_s - Magnitude(turn_rad_s) / 2));
}

// Half of what the body can do, and never more than the others count on.
double MostTurnOf(const RobotModel& profile) {
  return std::min(profile.max_turn_rad_s / 2, kTurnWhileDriving_rad_s);
}

// How far it may drive once it has turned: before what was heard there, and before a face that it
// hears to its side, which is longer than it was heard. Exact ultrasonics hear all of a face.
double FreeAfterTurn(double turned_rad, const Situation& s) {
  double free_m = s.own.slows_m;
  const Vec2 direction_body = {Cos(turned_rad), Sin(turned_rad)};
  const auto keep = [&free_m](std::optional<double> free) {
    if (free) free_m = std::min(free_m, *free);
  };
  const bool remembers = Remembers(s.own.options);
  for (const std::size_t i : BitsOf(s.own.ranges.Echoes())) {
    keep(remembers ? FreeAlongFace(i, turned_rad, s) : FreeOnceTurned(i, turned_rad, s));
  }
  keep(FreeOfPlaces(direction_body, s));
  return free_m;
}

// The highest speed at which the vehicle stops before what was heard where the turn leads to, by
// its end or halfway; empty where the path straight on is no longer.
std::optional<double> HeardLimitOfTurn(double turned_rad, const Situation& s) {
  const double free_m = std::min(FreeAfterTurn(turned_rad / 2, s), FreeAfterTurn(turned_rad, s));
  if (free_m >= s.own.slows_m || free_m >= FreeAfterTurn(0, s)) return std::nullopt;
  return SpeedToStopWithin(free_m, s.own.reaction_s, s.own.options.profile.deceleration_m_s2);
}

}  // namespace

std::optional<TurnLimit> LimitOfTurn(const Steering& steering, const Situation& s) {
  if (s.own.speed_m_s < kStandingSpeed_m_s) return std::nullopt;
  const RobotModel& profile = s.own.options.profile;
  const double stops_s = s.own.reaction_s + Seconds(s.own.options.tick_period) +
                         s.own.speed_m_s / profile.deceleration_m_s2;
  const double most_rad = MostTurnOf(profile) * stops_s;
  const double turned_rad = std::clamp(steering.heading_error_rad, -most_rad, most_rad);
  if (Magnitude(turned_rad) < kSmall_rad) return std::nullopt;
  const double heading_rad = s.own.world_from_body.heading_rad + turned_rad;
  const Vec2 forward_world = {Cos(heading_rad), Sin(heading_rad)};
  std::optional<TurnLimit> lowest;
  for (const PeerView& view : s.near.peers) {
    const double free_m = FreeAlong(view, forward_world, s.own);
    if (free_m >= s.own.slows_m || free_m >= view.free_m) continue;
    const double limit = SpeedToStopWithin(free_m, s.own.reaction_s, profile.deceleration_m_s2);
    if (!lowest || limit < lowest->max_speed_m_s) {
      lowest = TurnLimit{limit, view.peer->id, view.peer->beacon.tick};
    }
  }
  const std::optional<double> limit = HeardLimitOfTurn(turned_rad, s);
  if (limit && (!lowest || *limit < lowest->max_speed_m_s)) lowest = TurnLimit{*limit};
  return lowest;
}

namespace {

// Speeds of the two rims, m/s.
struct Rims {
  double left_m_s;
  double right_m_s;

  static Rims Of(const Twist& twist, double axle_m) {
    const double beside_m_s = twist.turn_rad_s * axle_m / 2;
    return {twist.forward_m_s - beside_m_s, twist.forward_m_s + beside_m_s};
  }
};

double Towards(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

// A rim one tick on: towards standstill it brakes, away from it it speeds up.
double RimAfterTick(const RobotModel& profile, double now_m_s, double target_m_s, double tick_s) {
  const double slower_m_s = profile.deceleration_m_s2 * tick_s;
  const bool reverses = now_m_s * target_m_s < 0;
  if (reverses || Magnitude(target_m_s) < Magnitude(now_m_s)) {
    return Towards(now_m_s, reverses ? 0 : target_m_s, slower_m_s);
  }
  return Towards(now_m_s, target_m_s, profile.acceleration_m_s2 * tick_s);
}

// A rim that speeds up faster than the other brakes carries the centre along: a turn must not make
// the vehicle faster than `limit_m_s`, nor keep it from braking to that as fast as it can. To come
// out of a turn the slower rim may keep its speed until the other is no faster. A vehicle that
// brakes at least as hard as it speeds up slows down in any turn.
Rims WithinLimit(const RobotModel& profile, const Rims& now, Rims target, double limit_m_s,
                 double tick_s) {
  constexpr double kRounding_m_s = 1e-9;  // of the sums that both sides are made by
  if (profile.acceleration_m_s2 <= profile.deceleration_m_s2) return target;
  const auto after = [&](double from, double to) {
    return RimAfterTick(profile, from, to, tick_s);
  };
  const double braked_m_s = (after(now.left_m_s, 0) + after(now.right_m_s, 0)) / 2;
  const bool is_left = target.left_m_s - now.left_m_s > target.right_m_s - now.right_m_s;
  double& gains = is_left ? target.left_m_s : target.right_m_s;
  const double gains_from = is_left ? now.left_m_s : now.right_m_s;
  const double other_from = is_left ? now.right_m_s : now.left_m_s;
  const double other_m_s = after(other_from, is_left ? target.right_m_s : target.left_m_s);
  double most_m_s = 2 * std::max(limit_m_s, braked_m_s) - other_m_s;
  if (gains_from < other_from) most_m_s = std::max(most_m_s, gains_from);
  if (after(gains_from, gains) > most_m_s + kRounding_m_s) gains = most_m_s;
  return target;
}

// Out of a turn sharper than the target's. It takes a little longer to stand: a rim that keeps its
// speed does not brake.
Rims Straightened(const RobotModel& profile, const Rims& now, Rims target, double tick_s) {
  const bool turns_left = now.left_m_s < now.right_m_s;
  const auto [inner_now, outer_now] = std::minmax(now.left_m_s, now.right_m_s);
  double& inner = turns_left ? target.left_m_s : target.right_m_s;
  double& outer = turns_left ? target.right_m_s : target.left_m_s;
  const double outer_after = RimAfterTick(profile, outer_now, outer, tick_s);
  const double turns_on_m_s = std::max(0.0, outer - inner);
  inner = std::max(inner, std::min(inner_now, outer_after - turns_on_m_s));
  // A drive slows the faster rim of a turn that is too sharp: the other must not ask for one.
  outer = std::max(outer, inner - profile.drive.axle_m * profile.max_turn_rad_s);
  return target;
}

}  // namespace

WheelSpeeds Drive(const RobotModel& profile, const Twist& now, const Steering& steering,
                  const Pace& pace) {
  if (pace.limit_m_s <= 0 && !pace.may_turn) return {};
  constexpr double kGain_per_s = 2.0;  // an error falls to a third in half a second
  const double error = steering.heading_error_rad;
  const double most_rad_s = MostTurnOf(profile);
  const double turn = std::clamp(kGain_per_s * error, -most_rad_s, most_rad_s);
  const bool on_the_spot = Magnitude(error) > kTurnOnTheSpot_rad;
  const double forward = std::min(SpeedBesideTurn(profile, now, turn, pace.limit_m_s),
                                  SpeedWithinTurn(profile, now, turn, most_rad_s));
  const WheelSpeeds wheels = WheelsFromTwist(profile.drive, {on_the_spot ? 0 : forward, turn});
  const double wheel_m = profile.drive.wheel_radius_m;
  const Rims wanted = {wheels.left_rad_s * wheel_m, wheels.right_rad_s * wheel_m};
  const Rims rims = Rims::Of(now, profile.drive.axle_m);
  Rims within = WithinLimit(profile, rims, wanted, pace.limit_m_s, pace.tick_s);
  if (pace.straightens) within = Straightened(profile, rims, within, pace.tick_s);
  return {within.left_m_s == wanted.left_m_s ? wheels.left_rad_s : within.left_m_s / wheel_m,
          within.right_m_s == wanted.right_m_s ? wheels.right_rad_s : within.right_m_s / wheel_m};
}

}  // namespace giveway
