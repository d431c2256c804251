#include "services/vehicle/situation/encounter.h"

#include <algorithm>

#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/situation/blocked.h"
#include "services/vehicle/situation/one_lane.h"
#include "services/vehicle/situation/timing.h"

namespace giveway {
namespace {

constexpr double kLostMargin_s = 1.0;  // on top of the time a silent peer may need to pass

// This one is steering round the halted vehicle, which would stop it there by setting off.
bool IsBeingPassed(const PeerView& view, const OwnView& s) {
  if (s.options.behaviour != Behaviour::kCooperative || !view.peer->encounter.holds) return false;
  return view.fresh && !view.standing && view.has_priority &&
         view.peer->beacon.rule == Rule::kSteerRound &&
         Dot(view.offset_world, s.path.direction_world) > 0;
}

// The nearest echo that is this peer's body; huge if no sensor hears it.
double NearestEchoOf(const PeerView& view, const OwnView& s) {
  double nearest = 1e9;
  for (const std::size_t i : BitsOf(view.explains)) {
    nearest = std::min(nearest, s.ranges[i].range_m);
  }
  return nearest;
}

// lecture_yield compares when the ultrasonics say "critically close"; cooperative as soon as the
// paths conflict, by beacon, or when the ultrasonics do: the union of both.
bool Begins(const PeerView& view, const OwnView& s) {
  if (!view.fresh || view.peer->beacon.mode == Mode::kLeaving) return false;
  const bool by_conflict = s.options.behaviour != Behaviour::kLectureYield;
  if (by_conflict && !view.conflict) return false;
  const double by_metric_m = view.gap_m - view.gate_gap_m;  // nearer by so much; never negative
  const bool critically_close = NearestEchoOf(view, s) - by_metric_m < CriticalDistance(s, view);
  if (!by_conflict) {
    const bool parting = !view.conflict && ClosingSpeed(view, s) <= 0;
    return critically_close && !parting && view.peer->beacon.rule != Rule::kArrived &&
           view.peer->beacon.rule != Rule::kLost;
  }
  return critically_close || !IsThroughFirst(view, s);
}

bool IsOver(const PeerView& view, const OwnView& s) {
  if (view.conflict || IsBeingPassed(view, s)) return false;
  return view.gate_gap_m >= s.options.gate_exit_m || ClosingSpeed(view, s) <= 0;
}

// A lost peer no longer holds any vehicle once it had the time to pass and nothing near is heard,
// or once the table has dropped it.
void UpdateLost(const PeerView& view, const OwnView& s) {
  Encounter& encounter = view.peer->encounter;
  if (!encounter.lost) {
    const double cruise = std::max(0.05, view.peer->beacon.cruise_m_s);
    encounter.lost = true;
    encounter.lost_at = s.now;
    encounter.lost_wait_s =
        (view.conflict ? view.conflict->peer.end_m / cruise : 0) + kLostMargin_s;
  }
  const double nearest = s.ranges.NearestEcho();
  const bool clear = nearest < 0 || nearest >= s.options.gate_exit_m ||
                     MutantActive(Mutant::kReleasedWithoutLooking);
  const bool waited = Seconds(s.now - encounter.lost_at) >= encounter.lost_wait_s;
  if (waited && clear && !MutantActive(Mutant::kLostPeerHeldForEver)) encounter.released = true;
}

// How far it may drive when it holds for the peer: up to the box; up to the conflict itself where
// it is in the box already.
double HoldsBefore(const PeerView& view) {
  return view.box_begin_m > 0 ? view.box_begin_m : view.conflict->own.begin_m;
}

// True where only braking now still ends before the conflict. Inside it, standing still helps no
// vehicle: this one drives out.
bool MustBrakeNow(const PeerView& view, const OwnView& s) {
  return view.conflict && view.conflict->own.begin_m > 0 &&
         HoldsBefore(view) <= OwnStoppingDistance(s);
}

// Both are in the conflict, and this vehicle is ahead along the paths of both.
bool IsAhead(const PeerView& view, const OwnView& s) {
  return Dot(view.offset_world, s.path.direction_world) < 0 &&
         Dot(view.offset_world, view.path_world) < 0;
}

// A vehicle in the middle of the conflict clears it instead of blocking it: if the other is not in
// it yet, or behind, or if it can be out before the other arrives.
bool MustClear(const PeerView& view, const OwnView& s) {
  if (!view.conflict || view.conflict->own.begin_m > 0 || IsBeingPassed(view, s)) return false;
  const bool cooperative = s.options.behaviour == Behaviour::kCooperative;
  if (cooperative && (view.conflict->peer.begin_m > 0 || IsAhead(view, s))) return true;
  return IsThroughFirst(view, s);
}

// Outside a one-lane section that the peer drives through in the other direction.
bool IsOutside(const PeerView& view) {
  return view.conflict && view.conflict->one_lane && view.conflict->own.begin_m > 0;
}

// It has entered, or drives out of the peer's path; or it is in a one-lane section, and the peer
// does not come towards it there: more wait for that than for the peer.
bool DrivesOut(const PeerView& view, const OwnView& s) {
  if (view.peer->encounter.entered || view.peer->encounter.clears) return true;
  if (view.conflict && view.conflict->one_lane) return false;
  return std::ranges::any_of(s.lanes.All(),
                             [](const LaneAhead& lane) { return lane.own.begin_m <= 0; });
}

// The vehicle without priority stops at the gate, or where only braking now is early enough.
bool SecondMustStop(const PeerView& view, const OwnView& s) {
  if (MutantActive(Mutant::kSecondDrivesOn)) return false;
  if (s.options.behaviour == Behaviour::kLectureYield) return true;
  if (!view.conflict) return false;
  const double critical_m = CriticalDistance(s, view);
  return (view.gate_gap_m <= critical_m && view.conflict->own.begin_m <= critical_m) ||
         HoldsBefore(view) <= OwnStoppingDistance(s);
}

// A peer that a light held let this vehicle go: once it cannot stop before the conflict any more
// it goes through, whatever the peer's light and the order say meanwhile.
bool EntersOnSignal(const PeerView& view, const OwnView& s) {
  return view.conflict->own.begin_m <= OwnStoppingDistance(s) && view.at_signal && view.grants &&
         !s.at_signal && !s.stop_line;
}

// Past the point where it could stop before the box: it drives through, whatever becomes of the
// order meanwhile. The others hold because it does not say that it gives way.
bool EntersBox(const PeerView& view, const OwnView& s) {
  if (s.options.behaviour != Behaviour::kCooperative || view.lost) return false;
  // A one-lane section may start later than the box that it is part of.
  const double before_m = IsOutside(view) ? view.conflict->own.begin_m : HoldsBefore(view);
  return s.speed_m_s >= kStandingSpeed_m_s && before_m <= OwnStoppingDistance(s);
}

// The peer has priority, but stands before the crossing because of a third vehicle: until that one
// is gone the crossing is free. This vehicle stops again if the peer starts; once it cannot stop
// any more it drives through (EntersBox) and no longer says that it gives way, and without that
// grant the peer does not enter. A peer that started on an older grant is still accelerating then:
// from standstill to where it cannot stop takes longer than a beacon may be old.
bool MayCrossBefore(const PeerView& view, const OwnView& s) {
  if (!view.believed || !view.standing || !view.conflict || !view.conflict->across) return false;
  if (view.conflict->peer.begin_m <= 0) return false;
  const Beacon& beacon = view.peer->beacon;
  const VehicleId waits_for = beacon.rule == Rule::kKeepClear ? beacon.blocked_by
                              : IsGiveWay(beacon.rule)        ? beacon.gives_way_to
                                                              : kNoVehicle;
  return waits_for != kNoVehicle && waits_for != s.options.id;
}

// Before a one-lane section this vehicle drives in behind others of its direction while the peer
// waits outside: each change of direction takes the time of a passage. Not if the peer has waited
// longer, nor if the section may be free again before the peer hears that this one is in.
bool FollowsIn(const PeerView& view, std::span<const PeerView> views, const OwnView& s) {
  constexpr double kSetsOff_s = 1;  // that the peer may set off before the section is free
  const bool waits = view.believed && view.standing;
  if (!waits || view.peer->beacon.order.waited_ticks > s.order.waited_ticks) return false;
  const double own_s = SecondsTo(view.conflict->own.begin_m, s);
  return own_s + kOneLaneHeard_s + kSetsOff_s < SecondsOccupied(*view.conflict, views, s);
}

// Whether this vehicle holds for the peer. A hold lasts once it has started: braking shortens the
// stopping distance, and a hold that ended whenever that is short enough would never stop the
// vehicle.
bool Holds(const PeerView& view, std::span<const PeerView> views, const OwnView& s) {
  const bool held = view.peer->encounter.holds;
  const bool stays = held || MustBrakeNow(view, s);
  const Behaviour behaviour = s.options.behaviour;
  if (view.lost) {
    if (view.peer->encounter.released || MutantActive(Mutant::kSilenceIsConsent)) return false;
    return stays || behaviour == Behaviour::kLectureYield;
  }
  if (DrivesOut(view, s)) return false;
  if (IsOutside(view) && view.conflict->peer.begin_m <= 0) return stays && !IsGoneInTime(view, s);
  if (!view.has_priority) {
    // The first needs the other's grant, or to be through before it; the lecture's behaviour trusts
    // the order alone.
    const bool trusts = behaviour == Behaviour::kLectureYield || view.grants;
    if (trusts || MutantActive(Mutant::kGrantNotNeeded)) return false;
    return stays && !IsThroughFirst(view, s);
  }
  if (IsOutside(view) && FollowsIn(view, views, s)) return false;
  const bool cooperative = behaviour == Behaviour::kCooperative;
  if (cooperative && (IsGoneInTime(view, s) || MayCrossBefore(view, s))) return false;
  return !MustClear(view, s) && (held || SecondMustStop(view, s));
}

}  // namespace

bool CanGiveWay(const PeerView& view, const OwnView& s) {
  if (!view.has_priority || DrivesOut(view, s) || MustClear(view, s)) return false;
  const bool stands = s.speed_m_s < kStandingSpeed_m_s;
  return stands || !view.conflict || view.conflict->own.begin_m > OwnStoppingDistance(s) - 0.1;
}

namespace {

void BeginOrEnd(const PeerView& view, std::span<const PeerView> views, const OwnView& s) {
  Encounter& encounter = view.peer->encounter;
  if (IsGone(*view.peer)) {
    encounter = {};
    return;
  }
  if (view.lost) {
    if (encounter.active) UpdateLost(view, s);
  } else {
    encounter.lost = false;
    encounter.released = false;
    if (!encounter.active) {
      encounter.active = Begins(view, s);
    } else if (IsOver(view, s)) {
      encounter = {};
    }
  }
  // A vehicle that blocks one with priority, by its body or by standing on its goal, gives way by
  // driving on: also at the far end of a queue in which each blocks the next. Not into a one-lane
  // section, where it would block more.
  const bool cooperative = s.options.behaviour == Behaviour::kCooperative;
  if (cooperative && encounter.active && !view.lost && view.has_priority && !IsOutside(view) &&
      (IsBehind(view.peer->beacon.blocked_by, s.options.id, views) || IsOnGoalOf(view, s))) {
    encounter.clears = true;
  }
  // Standing before the box again, the vehicle has not entered it.
  const bool stands_before = s.speed_m_s < kStandingSpeed_m_s && view.box_begin_m > 0;
  if (!encounter.active || !view.conflict || stands_before) encounter.entered = false;
  if (encounter.active && view.conflict && EntersOnSignal(view, s)) encounter.entered = true;
}

}  // namespace

Encounters UpdateEncounters(std::span<const PeerView> views, const OwnView& s) {
  Encounters all;
  for (const PeerView& view : views) {
    Encounter& encounter = view.peer->encounter;
    const bool met = encounter.active;
    BeginOrEnd(view, views, s);
    all.let_pass = all.let_pass || (met && !encounter.active && view.has_priority);
    encounter.holds = encounter.active && Holds(view, views, s);
    all.holds = all.holds || encounter.holds;
    all.meets = all.meets || encounter.active;
  }
  if (all.holds) return all;
  for (const PeerView& view : views) {
    Encounter& encounter = view.peer->encounter;
    if (encounter.active && view.conflict && EntersBox(view, s)) encounter.entered = true;
  }
  return all;
}

}  // namespace giveway
