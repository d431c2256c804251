#include "services/vehicle/encounter.h"

#include <algorithm>

namespace giveway {
namespace {

constexpr double kPeerSpeedSlack = 1.1;   // a peer's seed, slip and rounding
constexpr double kThroughMargin_s = 1.0;  // between leaving the conflict and its coming
constexpr double kLostMargin_s = 1.0;     // on top of the time a silent peer may need to pass

// The nearest echo that is this peer's body; huge if no sensor hears it.
double NearestEchoOf(const PeerView& view, const Situation& s) {
  double nearest = 1e9;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if ((view.explains >> i & 1U) != 0) nearest = std::min(nearest, s.ranges[i].range_m);
  }
  return nearest;
}

// lecture_yield compares when the ultrasonics say "critically close"; cooperative as soon as the
// paths conflict, by beacon, or when the ultrasonics do: the union of both.
bool Begins(const PeerView& view, const Situation& s) {
  if (!view.fresh || view.peer->beacon.mode == Mode::kLeaving) return false;
  const bool critically_close = NearestEchoOf(view, s) < s.options.gate_enter_m;
  if (s.options.behaviour == Behaviour::kLectureYield) {
    return critically_close && view.peer->beacon.rule != Rule::kArrived;
  }
  if (!view.conflict) return false;
  return critically_close || !IsThroughFirst(view, s);
}

bool IsOver(const PeerView& view, const Situation& s) {
  if (view.conflict) return false;
  return view.gap_m >= s.options.gate_exit_m || view.closing_m_s <= 0;
}

// A silent peer's encounter ends only when it had the time to pass and nothing near is heard.
void UpdateLost(const PeerView& view, const Situation& s) {
  Encounter& encounter = view.peer->encounter;
  if (!encounter.lost) {
    const double cruise = std::max(0.05, view.peer->beacon.cruise_m_s);
    encounter.lost = true;
    encounter.lost_at = s.now;
    encounter.lost_wait_s =
        (view.conflict ? view.conflict->peer.end_m / cruise : 0) + kLostMargin_s;
  }
  const double nearest = s.ranges.NearestEcho();
  const bool clear = nearest < 0 || nearest >= s.options.gate_exit_m;
  const bool waited = Seconds(s.now - encounter.lost_at) >= encounter.lost_wait_s;
  if (waited && clear) encounter.released = true;
}

// True once the stop for this encounter must begin: at the gate, or where only braking now still
// ends before the conflict.
bool MustStop(const PeerView& view, const Situation& s) {
  if (s.options.behaviour == Behaviour::kLectureYield) return true;
  if (view.conflict && view.conflict->own.begin_m <= OwnStoppingDistance(s)) return true;
  return view.conflict && view.gap_m <= CriticalDistance(s, view);
}

}  // namespace

bool IsThroughFirst(const PeerView& view, const Situation& s) {
  if (!view.conflict) return true;
  const VehicleProfile& profile = s.options.profile;
  const double own_s = TimeToCover(view.conflict->own.end_m, std::max(0.0, s.speed_m_s),
                                   s.options.cruise_m_s, profile.acceleration_m_s2);
  const double peer_speed =
      kPeerSpeedSlack * std::max(view.peer->beacon.cruise_m_s, view.speed_m_s);
  if (peer_speed <= 0) return true;
  return own_s + kThroughMargin_s < view.conflict->peer.begin_m / peer_speed;
}

bool CanGiveWay(const PeerView& view, const Situation& s) {
  if (!view.goes_first) return false;
  const bool stands = s.speed_m_s < kStandingSpeed_m_s;
  return stands || !view.conflict || view.conflict->own.begin_m > OwnStoppingDistance(s) - 0.1;
}

void UpdateEncounter(const PeerView& view, const Situation& s) {
  Encounter& encounter = view.peer->encounter;
  if (view.peer->left || view.peer->out_of_reach) {
    encounter = {};
    return;
  }
  if (view.lost) {
    if (encounter.active) UpdateLost(view, s);
    return;
  }
  if (!view.fresh) return;  // not yet known
  encounter.lost = false;
  encounter.released = false;
  if (!encounter.active) {
    encounter.active = Begins(view, s);
  } else if (IsOver(view, s)) {
    encounter = {};
  }
  if (encounter.active && view.goes_first && MustStop(view, s)) encounter.halted_for_it = true;
  if (!view.goes_first) encounter.halted_for_it = false;
}

}  // namespace giveway
