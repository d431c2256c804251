#include "services/vehicle/decision/decision_rules.h"

#include <algorithm>

#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/situation/blocked.h"
#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/situation/heard_places.h"
#include "services/vehicle/situation/objects_ahead.h"

namespace giveway {
namespace {

Proposal DeadStop(Rule rule) { return {.max_speed_m_s = 0, .may_turn = false, .rule = rule}; }

// Why this vehicle holds for that peer, if it does.
Rule HoldsBy(const PeerView& view) {
  if (view.lost) return Rule::kPeerLost;
  return view.has_priority ? Rule::kGiveWay : Rule::kNotGranted;
}

// A dead stop for the nearest peer that this vehicle holds for by that rule.
std::optional<Proposal> HoldFor(Rule rule, const Situation& s) {
  if (!s.near.encounters.holds) return std::nullopt;
  const PeerView* nearest = NearestOf(s.near.peers, [rule](const PeerView& view) {
    return view.peer->encounter.holds && HoldsBy(view) == rule;
  });
  if (nearest == nullptr) return std::nullopt;
  Proposal proposal = DeadStop(rule);
  proposal.peer = nearest->peer->id;
  // Silence has no tick that shows it: a lost peer is a cause without one.
  proposal.cause_tick = nearest->lost ? kNoTick : nearest->peer->beacon.tick;
  return proposal;
}

using RuleFunction = std::optional<Proposal> (*)(const Situation&);

// As a list that the compiler knows, so that each rule becomes part of one function.
template <RuleFunction... kRules>
std::optional<Proposal> LowestOf(const Situation& s) {
  std::optional<Proposal> lowest;
  const auto keep = [&lowest](const std::optional<Proposal>& proposal) {
    if (proposal && (!lowest || proposal->max_speed_m_s < lowest->max_speed_m_s)) {
      lowest = proposal;
    }
  };
  (keep(kRules(s)), ...);
  return lowest;
}

// The speed from which it stops within so much; empty where it cruises no faster.
std::optional<double> LimitWithin(double free_m, const Situation& s) {
  const double limit =
      SpeedToStopWithin(free_m, s.own.reaction_s, s.own.options.profile.deceleration_m_s2);
  if (limit >= s.own.options.cruise_m_s) return std::nullopt;
  return limit;
}

// What was heard ahead, be it by none any more: a cause without a tick that shows it.
std::optional<Proposal> HeardPlace(const Situation& s) {
  const std::optional<double> free_m = FreeOfPlaces({1, 0}, s);
  if (!free_m || MutantActive(Mutant::kObstacleIgnored)) return std::nullopt;
  const std::optional<double> limit = LimitWithin(*free_m - kStandOff_m, s);
  if (!limit) return std::nullopt;
  return Proposal{.max_speed_m_s = *limit, .may_turn = true, .rule = Rule::kObstacle};
}

// By how much it turns to the left from when echoes showed a slant, which is kClosingTime_s ago, to
// when it stands, on average: brakes stop no turn before. Away from what is on that side it may
// stop turning at any time.
double TurnsWhileBraking(bool is_left, const OwnView& s) {
  const double stops_s = s.reaction_s + s.speed_m_s / s.options.profile.deceleration_m_s2;
  const bool towards = (s.turn_rad_s > 0) == is_left;
  return s.turn_rad_s * (kClosingTime_s + (towards ? stops_s / 2 : 0));
}

// The lesser of how far it may go straight on and along a face that slants.
std::optional<double> FreeOfEcho(std::size_t sensor, const Situation& s) {
  const std::optional<double> ahead_m = FreeAhead(sensor, s);
  if (!Remembers(s.own.options)) return ahead_m;
  const bool is_left = s.own.cones.of[sensor].axis_body.y > 0;
  const std::optional<double> along_m = FreeAlongFace(sensor, TurnsWhileBraking(is_left, s.own), s);
  return !ahead_m || (along_m && *along_m < *ahead_m) ? along_m : ahead_m;
}

}  // namespace

std::optional<Proposal> Leaving(const Situation& s) {
  if (!s.own.leaving && !s.own.halting) return std::nullopt;
  return DeadStop(Rule::kLeaving);
}

std::optional<Proposal> NotRunning(const Situation& s) {
  if (s.own.run_state == RunState::kRunning) return std::nullopt;
  return DeadStop(Rule::kNotRunning);
}

std::optional<Proposal> RangesStale(const Situation& s) {
  Proposal proposal = DeadStop(Rule::kRangesStale);
  if (s.own.blind_sensor >= 0) {
    proposal.sensor = s.own.blind_sensor < static_cast<int>(kSensorCount) ? s.own.blind_sensor : -1;
    return proposal;
  }
  if (s.near.unheard == nullptr) return std::nullopt;
  proposal.peer = s.near.unheard->peer->id;
  return proposal;
}

std::optional<Proposal> Arrived(const Situation& s) {
  if (!s.own.arrived) return std::nullopt;
  return DeadStop(Rule::kArrived);
}

// A vehicle's own doubt about where it is. Others keep two standard deviations from where it says
// it is: beyond its limit it promises no place any more, stands, and says so.
std::optional<Proposal> Lost(const Situation& s) {
  if (!s.own.lost) return std::nullopt;
  return DeadStop(Rule::kLost);
}

std::optional<Proposal> Unsure(const Situation& s) {
  if (s.own.known_share >= 1) return std::nullopt;
  return Proposal{.max_speed_m_s = s.own.known_share * s.own.options.cruise_m_s,
                  .may_turn = true,
                  .rule = Rule::kUnsure};
}

std::optional<Proposal> GiveWay(const Situation& s) { return HoldFor(Rule::kGiveWay, s); }
std::optional<Proposal> NotGranted(const Situation& s) { return HoldFor(Rule::kNotGranted, s); }
std::optional<Proposal> PeerLost(const Situation& s) { return HoldFor(Rule::kPeerLost, s); }

std::optional<Proposal> Signal(const Situation& s) {
  if (!s.own.stop_line || MutantActive(Mutant::kSignalIgnored)) return std::nullopt;
  return Proposal{.max_speed_m_s = SpeedToStopWithin(s.own.stop_line->free_m, s.own.reaction_s,
                                                     s.own.options.profile.deceleration_m_s2),
                  .may_turn = false,
                  .rule = Rule::kSignal,
                  .cause_tick = s.own.stop_line->tick};
}

std::optional<Proposal> Object(const Situation& s) {
  const std::optional<ObjectAhead> object = NearestObstacle(s.own.objects, s);
  if (!object) return std::nullopt;
  const std::optional<double> limit = LimitWithin(object->free_m - kStandOff_m, s);
  if (!limit) return std::nullopt;
  return Proposal{
      .max_speed_m_s = *limit, .may_turn = true, .rule = Rule::kObject, .cause_tick = object->tick};
}

std::optional<Proposal> UnidentifiedMotion(const Situation& s) {
  if (!s.movers.unidentified || MutantActive(Mutant::kMoverIgnored)) return std::nullopt;
  Proposal proposal = DeadStop(Rule::kUnidentifiedMotion);
  proposal.sensor = s.movers.unidentified_sensor;
  proposal.cause_tick = s.own.tick;
  return proposal;
}

std::optional<Proposal> Obstacle(const Situation& s) {
  std::optional<Proposal> nearest;
  for (const std::size_t i : BitsOf(s.own.ranges.Echoes())) {
    const std::optional<double> free_m = FreeOfEcho(i, s);
    if (!free_m || MutantActive(Mutant::kObstacleIgnored)) continue;
    const std::optional<double> limit = LimitWithin(*free_m - kStandOff_m, s);
    if (!limit || (nearest && *limit >= nearest->max_speed_m_s)) continue;
    nearest = Proposal{.max_speed_m_s = *limit,
                       .may_turn = true,
                       .rule = Rule::kObstacle,
                       .sensor = static_cast<int>(i),
                       .cause_tick = s.own.tick};
  }
  const std::optional<Proposal> heard = HeardPlace(s);
  return heard && (!nearest || heard->max_speed_m_s < nearest->max_speed_m_s) ? heard : nearest;
}

std::optional<Proposal> KeepClear(const Situation& s) {
  std::optional<Proposal> lowest;
  for (const PeerView& view : s.near.peers) {
    if (view.free_m >= s.own.slows_m || MutantActive(Mutant::kClaimIgnored)) continue;
    if (MutantActive(Mutant::kBrakesTooLate) && view.free_m > 0) continue;
    const std::optional<double> limit = LimitWithin(view.free_m, s);
    if (!limit || (lowest && *limit >= lowest->max_speed_m_s)) continue;
    lowest = Proposal{.max_speed_m_s = *limit,
                      .may_turn = true,
                      .rule = Rule::kKeepClear,
                      .peer = view.peer->id,
                      .cause_tick = view.peer->beacon.tick};
  }
  return lowest;
}

std::optional<Proposal> KeepBoxClear(const Situation& s) {
  if (!s.near.blocked_box) return std::nullopt;
  const std::optional<double> limit = LimitWithin(s.near.blocked_box->begin_m - kInHand_m, s);
  if (!limit) return std::nullopt;
  return Proposal{.max_speed_m_s = *limit,
                  .may_turn = true,
                  .rule = Rule::kKeepClear,
                  .peer = s.near.blocked_box->by,
                  .cause_tick = s.near.blocked_box->beacon_tick};
}

namespace {

// Of a cooperative vehicle, without the rules for what stands still.
std::optional<Proposal> LowestBesidesObstacles(const Situation& s) {
  return LowestOf<Leaving, NotRunning, RangesStale, Arrived, Lost, Unsure, Signal, GiveWay,
                  NotGranted, PeerLost, UnidentifiedMotion, KeepClear, KeepBoxClear>(s);
}

}  // namespace

bool OnlyObstaclesSlow(const Situation& s) {
  const std::optional<Proposal> other = LowestBesidesObstacles(s);
  return !other || other->max_speed_m_s >= s.own.speed_m_s;
}

// The more informative reason comes first in each list.
std::optional<Proposal> MostRestrictive(const Situation& s) {
  switch (s.own.options.behaviour) {
    case Behaviour::kLectureAvoid:
    case Behaviour::kStockAvoid:
    case Behaviour::kLecturePrinted:
      return LowestOf<Leaving, NotRunning, RangesStale, Arrived, Lost>(s);
    case Behaviour::kLectureYield:
      return LowestOf<Leaving, NotRunning, RangesStale, Arrived, Lost, GiveWay, PeerLost,
                      UnidentifiedMotion, Obstacle>(s);
    case Behaviour::kCooperative:
      break;
  }
  return LowestOf<LowestBesidesObstacles, Obstacle, Object>(s);
}

}  // namespace giveway
