#include "services/vehicle/decision/decide.h"

#include <algorithm>
#include <numbers>

#include "services/vehicle/decision/decision_rules.h"
#include "services/vehicle/decision/lecture.h"
#include "services/vehicle/decision/steering.h"
#include "services/vehicle/decision/turn_room.h"
#include "services/vehicle/situation/blocked.h"
#include "services/vehicle/situation/claim.h"
#include "services/vehicle/situation/encounter.h"

namespace giveway {
namespace {

// Past a standing vehicle, and away from what stopped it, at walking pace and no faster than the
// cruise. The second is a heading without a goal: at 0.8 m/s it crossed a lane within a second, and
// the ultrasonics showed the wall on the other side too late.
constexpr double kRoundSpeed_m_s = 0.2;

// The ladder: how much of what a decision wants to know is known.
Mode ModeOf(const Situation& s) {
  if (s.own.leaving) return Mode::kLeaving;
  if (s.own.blind_sensor >= 0 || s.own.lost || s.near.unheard != nullptr) return Mode::kHalt;
  return s.movers.unidentified || s.near.someone_lost || s.near.someone_doubted
             ? Mode::kSensorOnly
             : Mode::kCooperative;
}

Action AvoidingAction(const Situation& s) {
  const Avoidance avoidance = Avoid(s.own.options.braitenberg, s.own.ranges);
  Action action{.target = avoidance.wheels};
  action.decision.rule = avoidance.sensor >= 0 ? Rule::kAvoid : Rule::kCruise;
  action.decision.sensor = avoidance.sensor;
  action.decision.cause_tick = avoidance.sensor >= 0 ? s.own.tick : kNoTick;
  return action;
}

// The turn that this vehicle is too fast for, if it is.
std::optional<TurnLimit> TurnTooFast(const Steering& steering, const Situation& s) {
  if (s.own.options.behaviour != Behaviour::kCooperative) return std::nullopt;
  const std::optional<TurnLimit> turn = LimitOfTurn(steering, s);
  return turn && turn->max_speed_m_s < s.own.speed_m_s ? turn : std::nullopt;
}

// True if it had better come out of a turn than stand as soon as it can: with brakes weaker than
// the motors it turns far until it stands, and the rules measure how far is free straight ahead.
// Where peers count on its braking, it brakes. A turn that may be noise is none: one rim and then
// the other would not brake, tick by tick, and both by half as much as they can.
bool Straightens(const Decision& decision, const Situation& s) {
  const RobotModel& profile = s.own.options.profile;
  if (profile.acceleration_m_s2 <= profile.deceleration_m_s2) return false;
  if (s.own.options.behaviour != Behaviour::kCooperative) return false;
  if (decision.rule != Rule::kObstacle && decision.rule != Rule::kObject) return false;
  // What the noise of both encoders, two independent errors, shows of one that drives straight on.
  const double noise_m_s = std::numbers::sqrt2 * profile.encoder_noise * Magnitude(s.own.speed_m_s);
  return Magnitude(s.own.turn_rad_s) * profile.drive.axle_m > kSigmas * noise_m_s &&
         OnlyObstaclesSlow(s);
}

// Drives to the goal no faster than `limit`, slowing so that it can stop there.
Action DrivingAction(const Situation& s, const std::optional<Proposal>& limit) {
  const RobotModel& profile = s.own.options.profile;
  Steering steering = SteerToGoal(s);
  Action action;
  double speed = s.own.options.cruise_m_s;
  if (s.own.stops_there) {
    speed = std::min(speed, SpeedToStopWithin(s.own.distance_to_goal_m, s.own.reaction_s,
                                              profile.deceleration_m_s2));
  }
  action.decision.rule = Rule::kCruise;
  if (steering.gets_away || steering.round != kNoVehicle) speed = std::min(speed, kRoundSpeed_m_s);
  if (steering.round != kNoVehicle) {
    action.decision.rule = Rule::kSteerRound;
    action.decision.peer = steering.round;
  }
  bool may_turn = true;
  // Also of one that takes nothing off: exactly on its goal it stands anyhow, and says why.
  if (limit && limit->max_speed_m_s <= speed) {
    speed = limit->max_speed_m_s;
    may_turn = limit->may_turn;
    action.decision = {.rule = limit->rule,
                       .peer = limit->peer,
                       .sensor = limit->sensor,
                       .cause_tick = limit->cause_tick};
  }
  if (const auto turn = TurnTooFast(steering, s); turn && turn->max_speed_m_s <= speed) {
    speed = turn->max_speed_m_s;
    action.decision = {.rule = turn->peer == kNoVehicle ? Rule::kObstacle : Rule::kKeepClear,
                       .peer = turn->peer,
                       .cause_tick = turn->cause_tick};
    // Straight on until it is slow enough for the turn: both rims brake alike.
    steering.heading_error_rad = 0;
  }
  if (s.own.speed_m_s < kStandingSpeed_m_s ||
      Magnitude(steering.heading_error_rad) > kTurnOnTheSpot_rad) {
    steering.heading_error_rad = TurnWithinRoom(steering.heading_error_rad, profile, s.places);
  }
  action.blocked_by = steering.blocked_by;
  action.steer_side = steering.side;
  action.away_rad = steering.away_rad;
  action.target = Drive(profile, {s.own.speed_m_s, s.own.turn_rad_s}, steering,
                        {.limit_m_s = speed,
                         .may_turn = may_turn,
                         .tick_s = Seconds(s.own.options.tick_period),
                         .straightens = Straightens(action.decision, s)});
  return action;
}

// A red light ahead is published even if another rule limits the speed now: peers rely on this
// vehicle staying behind its line. Only rules that stop the vehicle anyway keep their name.
bool IsReportedAsLight(Rule rule) {
  switch (rule) {
    case Rule::kCruise:
    case Rule::kUnsure:
    case Rule::kGiveWay:
    case Rule::kNotGranted:
    case Rule::kObstacle:
    case Rule::kObject:
    case Rule::kSteerRound:
      return true;
    default:
      return false;
  }
}

// True if the line is near enough to publish, and no conflict with a known peer lies before it.
bool StandsAtLine(const StopLine& line, const Situation& s) {
  constexpr double kReportWithin_m = 2.5;
  return line.free_m < kReportWithin_m &&
         std::none_of(s.near.peers.begin(), s.near.peers.end(), [&line](const PeerView& view) {
           return view.conflict && view.conflict->own.begin_m < line.free_m;
         });
}

}  // namespace

Action Decide(const Situation& s) {
  const std::optional<Proposal> limit = MostRestrictive(s);
  const Behaviour behaviour = s.own.options.behaviour;
  const bool avoids = behaviour == Behaviour::kLectureAvoid || behaviour == Behaviour::kStockAvoid;
  Action action = avoids && !limit ? AvoidingAction(s) : DrivingAction(s, limit);
  if (behaviour == Behaviour::kLecturePrinted && !limit) action = AsPrinted(s, action);
  if (s.own.stop_line && IsReportedAsLight(action.decision.rule) &&
      StandsAtLine(*s.own.stop_line, s)) {
    action.decision = {.rule = Rule::kSignal, .cause_tick = s.own.stop_line->tick};
  }
  action.decision.mode = ModeOf(s);
  return action;
}

VehicleId GivesWayTo(const Situation& s) {
  const PeerView* nearest = NearestOf(s.near.peers, [&s](const PeerView& view) {
    return view.peer->encounter.active && view.fresh && CanGiveWay(view, s.own);
  });
  return nearest == nullptr ? kNoVehicle : nearest->peer->id;
}

}  // namespace giveway
