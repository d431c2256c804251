#include "services/vehicle/situation/sonar_trust.h"

#include <algorithm>
#include <chrono>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/bits.h"
#include "services/vehicle/estimation/trust.h"

namespace giveway {
namespace {

// In so many ticks it must have shown. Random readings look like working ones now and then.
constexpr std::uint32_t kShownTicks = 5;
// From a centre to its shell, of any robot of the fleet.
constexpr double kBody_m = 0.5;
// A world removes a silent body silent_body_stays after its last command. The last beacon heard may
// be older than that command, and it may be younger: by so much, or by half of it where that is
// less.
constexpr Nanoseconds kRemovalSlack = std::chrono::seconds(2);
// It removes one that leaves at once.
constexpr double kJustLeft_s = 1;
// One that only its radio silences drives on. Where it is after so long, nothing says.
constexpr double kDrivesOn_s = 4;

// After this a silent body may have been removed, and after RemovedAfter it has been.
double StillThere(const VehicleOptions& options) {
  const Nanoseconds stays = options.silent_body_stays;
  return Seconds(std::max(stays - kRemovalSlack, stays / 2));
}
double RemovedAfter(const VehicleOptions& options) {
  return Seconds(options.silent_body_stays + kRemovalSlack);
}

double SilentSeconds(const PeerView& view, const OwnView& s) {
  return Seconds(Age(*view.peer, s.now, s.tick, s.options.tick_period));
}

// Where a peer can be by now that fell silent.
struct Disc {
  Vec2 centre_body;
  double radius_m;
};

Disc WhereItIs(const PeerView& view, double silent_s, const OwnView& s) {
  const Beacon& beacon = view.peer->beacon;
  const Vec2 centre = InBody(s, beacon.world_from_body.position_world);
  const double fastest_m_s = std::max(beacon.cruise_m_s, Magnitude(view.speed_m_s));
  return {centre, fastest_m_s * silent_s + kPoseSlack_m +
                      kErrorSigmas * (view.sigma_m + SigmaHeading(s.covariance) * Norm(centre))};
}

// True if it cannot be out of the cones ahead, which leave no gap between each other.
bool MustBeAhead(const Disc& place, const OwnView& s) {
  const Vec2 centre = place.centre_body;
  const double inside_m =
      s.cones.ahead_sine * centre.x - s.cones.ahead_cosine * Magnitude(centre.y);
  return inside_m >= place.radius_m &&
         Norm(centre) + place.radius_m <= s.options.profile.sonar_max_range_m;
}

// True if its body can be what that sensor heard until the tick before.
bool CanHaveBeen(const Disc& place, std::size_t sensor, const OwnView& s) {
  const double was_m = s.change.was_m[sensor];
  const Vec2 echo_body =
      s.options.profile.sonar[sensor].position_body + was_m * s.cones.of[sensor].axis_body;
  const double within_m = place.radius_m + kBody_m + was_m * s.cones.half_sine;
  return SquaredNorm(echo_body - place.centre_body) <= within_m * within_m;
}

// True of one that the world may have taken away just now: it left, or was silent for long.
bool MayBeTakenAway(const PeerView& view, double silent_s, const VehicleOptions& options) {
  if (view.fresh) return false;
  if (IsGone(*view.peer)) return silent_s <= kJustLeft_s;
  return silent_s > StillThere(options) && silent_s <= RemovedAfter(options);
}

// True if an echo vanished that no body can have been that the world took away: whatever it was,
// the ultrasonics do not hear it any more.
bool HasVanished(std::span<const PeerView> views, const OwnView& s) {
  const auto was_taken_away = [&](std::size_t sensor) {
    return std::ranges::any_of(views, [&](const PeerView& view) {
      const double silent_s = SilentSeconds(view, s);
      return MayBeTakenAway(view, silent_s, s.options) &&
             CanHaveBeen(WhereItIs(view, silent_s, s), sensor, s);
    });
  };
  for (const std::size_t i : BitsOf(s.change.echoes)) {
    if (!was_taken_away(i)) return true;
  }
  return false;
}

// True if working ultrasonics, which miss nothing, hear its body: it says that it is squarely in
// one of their cones, or cannot have left those ahead since it fell silent.
bool MustBeHeard(const PeerView& view, const OwnView& s) {
  if (IsGone(*view.peer)) return false;
  if (view.peer->trust.missing_ticks > 0) return true;  // then it is fresh: JudgeEchoes
  const double silent_s = SilentSeconds(view, s);
  return silent_s <= StillThere(s.options) && MustBeAhead(WhereItIs(view, silent_s, s), s);
}

// True if working ultrasonics hear something else from tick to tick. Side cones of one that drives
// straight on along a wall do not.
bool MustHearChanges(const OwnView& s) {
  if (Magnitude(s.turn_rad_s) > kTurning_rad_s) return true;
  return Magnitude(s.speed_m_s) >= kStandingSpeed_m_s && (s.change.echoes & s.cones.amid) != 0;
}

// In how many ticks this scan shows that the ultrasonics do not work: that they do not hear what
// they must, or hear what no working ones do.
std::uint32_t TicksShown(std::span<const PeerView> views, const OwnView& s) {
  const bool exact = !HasImperfectSonar(s.options);
  switch (s.change.news) {
    case ScanNews::kAllClear: {
      if (!exact) return 0;
      if (HasVanished(views, s)) return kShownTicks;
      const auto must_be_heard = [&](const PeerView& view) { return MustBeHeard(view, s); };
      return std::ranges::any_of(views, must_be_heard) ? 1 : 0;
    }
    case ScanNews::kSame:
      return MustHearChanges(s) ? 1 : 0;
    case ScanNews::kLeaps:  // one that turns past corners hears leaps as well
      return exact && Magnitude(s.turn_rad_s) <= kTurning_rad_s ? 1 : 0;
    default:
      return 0;
  }
}

// Counts up while scans show one and the same thing, and down while they show another. What has
// been shown stays so while scans continue like that.
void Note(ScanNews news, std::uint32_t shown, SonarDoubt* doubt) {
  constexpr std::uint32_t kMost = 2 * kShownTicks;
  if (doubt->ticks > 0 && news != doubt->shown_by) {
    if (--doubt->ticks == 0) *doubt = {};
    return;
  }
  if (shown == 0 && doubt->ticks < kShownTicks) *doubt = {};
  if (shown == 0) return;
  *doubt = {news, std::min(doubt->ticks + shown, kMost)};
}

// Where a transducer can hear it, when it fell silent. However long ago that was: one without
// ultrasonics does not see that the world has taken it away.
bool MayBeNear(const PeerView& view, const OwnView& s) {
  const double silent_s = std::min(SilentSeconds(view, s), kDrivesOn_s);
  const Disc place = WhereItIs(view, silent_s, s);
  const double hears_m = s.options.profile.sonar_max_range_m + 2 * kBody_m;  // centre to centre
  return Norm(place.centre_body) - place.radius_m <= hears_m;
}

}  // namespace

void JudgeSonar(std::span<const PeerView> views, const OwnView& s, SonarDoubt* doubt) {
  const bool cooperative = s.options.behaviour == Behaviour::kCooperative;
  if (!cooperative || s.run_state != RunState::kRunning || !s.new_tick) return;
  if (s.change.news == ScanNews::kNone) return;
  Note(s.change.news, TicksShown(views, s), doubt);
}

const PeerView* FindUnheard(std::span<const PeerView> views, const OwnView& s,
                            const SonarDoubt& doubt) {
  if (doubt.ticks < kShownTicks) return nullptr;
  const auto unheard = std::ranges::find_if(
      views, [&](const PeerView& view) { return view.lost && MayBeNear(view, s); });
  return unheard == views.end() ? nullptr : &*unheard;
}

}  // namespace giveway
