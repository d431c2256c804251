#include "services/vehicle/situation/echo_trust.h"

#include <algorithm>
#include <chrono>

#include "services/types/math/math.h"
#include "services/types/time.h"
#include "services/vehicle/estimation/bits.h"
#include "services/vehicle/estimation/trust.h"
#include "services/vehicle/situation/echoes.h"

namespace giveway {
namespace {

// A body that must be heard is not, so often in a row.
constexpr std::uint32_t kMissingTicks = 5;
// It stands, by its own word, for longer than any smoothed closing speed remembers its driving.
constexpr Nanoseconds kStands = std::chrono::seconds(1);
// Longer than a beacon is fresh: within that it may have driven off without being heard to.
constexpr Nanoseconds kCloses = std::chrono::milliseconds(400);

// Where a peer says its centre is, and by how much that may be off, to this vehicle.
struct Place {
  Vec2 centre_body;
  double error_m = 0;
};

Place PlaceOf(const PeerView& view, const OwnView& s) {
  const Vec2 centre = InBody(s, view.position_world);
  return {centre,
          kPoseSlack_m + kErrorSigmas * (view.sigma_m + SigmaHeading(s.covariance) * Norm(centre))};
}

// True if a sensor that has just fired heard nothing as near as the centre, which surely lies in
// its cone and not so near that the body is all around it: whatever hides a body is nearer still.
// By the centre, not the shell, for the body need not be round.
bool MissesBody(std::size_t sensor, const Place& place, const OwnView& s) {
  constexpr double kTooNear_m = 0.4;
  const Vec2 axis_body = s.cones.of[sensor].axis_body;
  const Vec2 to = place.centre_body - s.options.profile.sonar[sensor].position_body;
  if (Dot(axis_body, to) < kTooNear_m) return false;
  const double across = Magnitude(Cross(axis_body, to)) + place.error_m;
  if (!(across * across <= s.cones.half_sine * s.cones.half_sine * SquaredNorm(to))) return false;
  const SensorView& heard = s.ranges[sensor];
  const double free_m =
      heard.kind == Echo::kClear ? s.options.profile.sonar_max_range_m : heard.range_m;
  const double surely_m = free_m * (1 - kNoiseSigmas * s.options.sonar_noise) - place.error_m;
  return surely_m > 0 && SquaredNorm(to) < surely_m * surely_m;
}

// True if no echo is where its body should be, and a sensor should have heard one.
bool IsMissed(const PeerView& view, std::uint32_t listening, const OwnView& s) {
  if (view.explains != 0) return false;
  const double far_m = s.options.profile.sonar_max_range_m + s.options.profile.body_radius_m;
  if (SquaredNorm(view.offset_world) > far_m * far_m) return false;
  const Place place = PlaceOf(view, s);
  for (const std::size_t i : BitsOf(listening)) {
    if (MissesBody(i, place, s)) return true;
  }
  return false;
}

// True where nothing that stands can seem to come nearer by more than the own speed: the vehicle
// stands as well, or drives straight on and the cone holds what is straight ahead. Into any other
// cone the end of a wall may come from the side, and its echo leaps.
bool ShowsMotion(std::size_t sensor, const OwnView& s) {
  if (s.turns || Magnitude(s.turn_rad_s) > kTurning_rad_s) return false;
  if (Magnitude(s.speed_m_s) < kStandingSpeed_m_s) return true;
  return s.speed_m_s > 0 && s.cones.of[sensor].nearest_cosine >= 1;
}

// Whether its echoes move by themselves: all that can be no other peer's. What one cone alone hears
// to come nearer may be a vehicle between the two, whose own beacon is too far off to explain it.
bool ComesNearer(const PeerView& view, std::span<const PeerView> views, const OwnView& s) {
  constexpr double kDeepest_m = 1;  // from shell to centre
  bool any = false;
  for (const std::size_t i : BitsOf(view.explains)) {
    const bool in_reach = s.ranges[i].range_m + kDeepest_m < s.options.emission_radius_m;
    if (!in_reach || !ShowsMotion(i, s)) continue;
    const auto can_be = [i](const PeerView& other) { return (other.explains >> i & 1U) != 0; };
    if (std::ranges::count_if(views, can_be) > 1) continue;
    if (!MovesByItself(i, s)) return false;
    any = true;
  }
  return any;
}

}  // namespace

void JudgeEchoes(std::span<const PeerView> views, bool someone_lost, const OwnView& s,
                 TrustCounters* counters) {
  if (s.run_state != RunState::kRunning || !s.new_tick) return;
  const std::uint32_t stands = TicksCovering(kStands, s.options.tick_period);
  // At least one: in ticks that are longer, it must have been shown all the same.
  const auto closes = std::max<std::uint32_t>(
      1,
      static_cast<std::uint32_t>((kCloses + 2 * s.options.sonar_refresh) / s.options.tick_period));
  // Ultrasonics that miss obstacles, by their slant or by chance, or take a neighbour's ping for an
  // echo, are no evidence against a peer.
  const bool believes_sonar = !HasImperfectSonar(s.options);
  const std::uint32_t listening = s.cones.enabled & s.ranges.SpokeAt(s.tick);
  for (const PeerView& view : views) {
    PeerTrust& trust = view.peer->trust;
    if (!view.fresh) [[unlikely]] {
      trust.missing_ticks = trust.standing_ticks = trust.closing_ticks = 0;
      continue;
    }
    trust.missing_ticks = IsMissed(view, listening, s) ? trust.missing_ticks + 1 : 0;
    if (trust.missing_ticks == kMissingTicks) ++counters->beacon_without_echo;
    if (trust.missing_ticks >= kMissingTicks && believes_sonar) Doubt(&trust, s.now);

    const bool says_it_stands = view.standing && Magnitude(view.turn_rad_s) < kTurning_rad_s;
    trust.standing_ticks = says_it_stands ? trust.standing_ticks + 1 : 0;
    // Not while one that has fallen silent may roll by.
    const bool closing =
        trust.standing_ticks > stands && !someone_lost && ComesNearer(view, views, s);
    trust.closing_ticks = closing ? trust.closing_ticks + 1 : 0;
    if (trust.closing_ticks == closes) ++counters->halted_but_closing;
    if (trust.closing_ticks >= closes && believes_sonar) Doubt(&trust, s.now);
  }
}

}  // namespace giveway
