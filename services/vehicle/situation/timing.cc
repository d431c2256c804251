#include "services/vehicle/situation/timing.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/situation/claim.h"

namespace giveway {
namespace {

constexpr double kThroughMargin_s = 0.05;  // between leaving the conflict and its coming
constexpr double kGoneMargin_s = 0.3;      // it has left, and a beacon has reported so

// Two vehicles that pass a conflict one after the other need less distance than two that stop
// wherever they like: one is past the crossing by as much as the other is before it. With the angle
// a between the paths both may be nearer to it by sin(a / 2). Of a one-lane section they need all.
Conflict Shrunk(const Conflict& conflict, Vec2 own_path, Vec2 peer_path) {
  if (conflict.one_lane) return conflict;
  const double share = Sqrt(std::clamp((1 - Dot(own_path, peer_path)) / 2, 0.25, 1.0));
  const auto shrunk = [share](const Stretch& stretch) {
    const double middle_m = (stretch.begin_m + stretch.end_m) / 2;
    const double half_m = share * (stretch.end_m - stretch.begin_m) / 2;
    return Stretch{middle_m - half_m, middle_m + half_m};
  };
  return {shrunk(conflict.own), shrunk(conflict.peer), conflict.across};
}

// One that is in the conflict already is counted on to be anywhere in it.
Conflict InTurn(const Conflict& conflict, Vec2 own_path, Vec2 peer_path) {
  if (conflict.own.begin_m <= 0 || conflict.peer.begin_m <= 0) return conflict;
  return Shrunk(conflict, own_path, peer_path);
}

}  // namespace

double SecondsTo(double distance_m, const OwnView& s) {
  return TimeToCover(distance_m, std::max(0.0, s.speed_m_s), s.options.cruise_m_s,
                     s.options.profile.acceleration_m_s2);
}

double FastestOf(const CarriedPeer& view) {
  return kCruiseSlack * std::max(view.peer->beacon.cruise_m_s, view.speed_m_s);
}

bool IsThroughFirst(const RelatedPeer& view, const OwnView& s) {
  if (!view.conflict || MutantActive(Mutant::kThroughFirstGuessed)) return true;
  const double fastest_m_s = FastestOf(view);
  if (fastest_m_s <= 0) return true;
  const Beacon& beacon = view.peer->beacon;
  const auto peer_takes_s = [&](double distance_m) {
    return TimeToCover(distance_m, std::max(0.0, view.speed_m_s), fastest_m_s,
                       beacon.acceleration_m_s2);
  };
  // Who is in a one-lane section is waited for by all that come towards it, whatever the order: it
  // is enough to be in before the peer, hearing of that, could not stop outside any more.
  if (view.conflict->one_lane) {
    const double stops_m = StoppingDistance(fastest_m_s, s.reaction_s, beacon.deceleration_m_s2);
    return SecondsTo(view.conflict->own.begin_m, s) + kOneLaneHeard_s <
           peer_takes_s(view.conflict->peer.begin_m - stops_m);
  }
  const Conflict conflict =
      InTurn(*view.conflict, s.path.direction_world, view.path_direction_world);
  const double own_s = SecondsTo(conflict.own.end_m, s);
  const double peer_s = peer_takes_s(conflict.peer.begin_m);
  return own_s + kThroughMargin_s < peer_s;
}

bool IsGoneInTime(const RelatedPeer& view, const OwnView& s) {
  if (!view.fresh || !view.conflict || view.speed_m_s < kStandingSpeed_m_s) return false;
  const Conflict conflict =
      Shrunk(*view.conflict, s.path.direction_world, view.path_direction_world);
  if (conflict.peer.end_m <= 0) return true;
  if (conflict.own.begin_m <= 0) return false;
  const double own_s = SecondsTo(conflict.own.begin_m, s);
  return conflict.peer.end_m / view.speed_m_s + kGoneMargin_s < own_s;
}

}  // namespace giveway
