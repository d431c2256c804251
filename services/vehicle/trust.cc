#include "services/vehicle/trust.h"

#include <algorithm>

#include "services/types/fleet_limits.h"
#include "services/vehicle/echoes.h"

namespace giveway {
namespace {

// Beyond which errors are no errors any more, in standard deviations of each pose.
constexpr double kSigmas = 3;
// On top of that: slip within a tick, speeding up since the beacon.
constexpr double kPoseSlack_m = 0.15;
// What encoders and slip may add to a speed, as a share of it.
constexpr double kSpeedSlack = 1.5;
constexpr double kGain_m_s = 0.1;  // and to what is gained from one beacon to the next

// A body that must be heard is not, so often in a row.
constexpr std::uint32_t kMissingTicks = 5;
// It stands, by its own word, for longer than any smoothed closing speed remembers its driving.
constexpr double kStands_s = 1;
// Longer than a beacon is fresh: within that it may have driven off without being heard to.
constexpr double kCloses_s = 0.4;

double Magnitude(double x) { return x < 0 ? -x : x; }

void Doubt(PeerTrust* trust, SteadyTime now) {
  trust->ever_doubted = true;
  trust->doubted_at = now;
}

double Pace(const Beacon& beacon) {
  return Magnitude(TwistFromWheels(beacon.drive, beacon.wheels).forward_m_s);
}

// Farther than it could have come.
bool Jumps(const Beacon& before, const Beacon& now, double dt_s) {
  const double fastest = kSpeedSlack * std::max({Pace(before), Pace(now), now.cruise_m_s});
  const double most_m = fastest * dt_s + kPoseSlack_m +
                        kSigmas * (before.sigma_position_m + now.sigma_position_m);
  const Vec2 way = now.world_from_body.position_world - before.world_from_body.position_world;
  return SquaredNorm(way) > most_m * most_m;
}

// Faster than anybody of this fleet, or sped up faster than it says it can.
bool IsTooFast(const Beacon& before, const Beacon& now, double dt_s) {
  const double pace = Pace(now);
  if (pace > kMaxSpeed_m_s) return true;
  // A wheel that stops rolling backwards speeds the body up, and it may do that by braking.
  const double rate_m_s2 = std::max(now.acceleration_m_s2, now.deceleration_m_s2);
  return pace > kSpeedSlack * (Pace(before) + rate_m_s2 * dt_s) + kGain_m_s;
}

// How far off the place of a peer may be, to this vehicle.
double PlaceError(const PeerView& view, const Situation& s) {
  return kPoseSlack_m + kSigmas * (s.sigma_position_m + view.peer->beacon.sigma_position_m);
}

// True if the sensor fired just now and did not hear what it must have heard, if the body's centre
// is where it is said to be: it lies well inside the cone, and whatever hides it is nearer still.
// By the centre, not the shell: a box may have no corner there.
bool MissesBody(std::size_t sensor, Vec2 centre_body, double error_m, const Situation& s) {
  constexpr double kTooNear_m = 0.4;
  const SensorMount& mount = s.options.profile.sonar[sensor];
  const SensorView& heard = s.ranges[sensor];
  if (!mount.enabled || heard.kind == Echo::kNoData) return false;
  if (heard.tick != s.tick || heard.missed) return false;
  const Vec2 to = centre_body - mount.position_body;
  if (Dot(s.cones.of[sensor].axis_body, to) < kTooNear_m) return false;
  const double squared = SquaredNorm(to);
  const double across = Magnitude(Cross(s.cones.of[sensor].axis_body, to)) + error_m;
  if (across * across > s.cones.half_sine * s.cones.half_sine * squared) return false;
  const double reach_m = heard.kind == Echo::kClear ? s.options.profile.sonar_max_range_m
                                                    : std::max(0.0, heard.range_m);
  const double surely_m = reach_m * (1 - 4 * s.options.sonar_noise) - error_m;
  return surely_m > 0 && squared < surely_m * surely_m;
}

bool IsMissed(const PeerView& view, const Situation& s) {
  const Vec2 centre = InBody(s, view.world_from_body.position_world);
  const double far_m = s.options.profile.sonar_max_range_m + s.options.profile.body_radius_m;
  const double distance_squared = SquaredNorm(centre);
  if (distance_squared > far_m * far_m) return false;
  const double distance = Sqrt(distance_squared);
  const double error_m = PlaceError(view, s) + kSigmas * s.sigma_heading_rad * distance;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (MissesBody(i, centre, error_m, s)) return true;
  }
  return false;
}

// The only one whose body the echo of this sensor can be.
bool IsItAlone(const PeerView& view, std::size_t sensor, std::span<const PeerView> views) {
  return std::all_of(views.begin(), views.end(), [&](const PeerView& other) {
    return other.peer == view.peer || (other.explains >> sensor & 1U) == 0;
  });
}

bool ComesNearer(const PeerView& view, std::span<const PeerView> views, const Situation& s) {
  // A cone that swings, and one that has fallen silent and rolls on, make echoes of any kind.
  if (s.turns || s.someone_lost) return false;
  for (const std::size_t i : BitsOf(view.explains)) {
    if (MovesByItself(i, s) && IsItAlone(view, i, views)) return true;
  }
  return false;
}

bool SaysItStands(const PeerView& view) {
  constexpr double kTurning_rad_s = 0.02;
  const Beacon& beacon = view.peer->beacon;
  const double turn_rad_s = TwistFromWheels(beacon.drive, beacon.wheels).turn_rad_s;
  return view.standing && Magnitude(turn_rad_s) < kTurning_rad_s;
}

std::uint32_t TicksOf(double time_s, const VehicleOptions& options) {
  return static_cast<std::uint32_t>(time_s / Seconds(options.tick_period));
}

}  // namespace

void JudgeBeacon(const Beacon& before, const ReceivedBeacon& received,
                 const VehicleOptions& options, PeerTrust* trust, TrustCounters* counters) {
  const Beacon& now = received.beacon;
  // After a silence, or the tick it counts begun anew: there is nothing to compare with.
  if (before.tick == kNoTick || now.tick < before.tick) return;
  const Nanoseconds between = TicksBetween(before.tick, now.tick) * options.tick_period;
  if (between > options.beacon_age_limit) return;
  const double dt_s = Seconds(between);
  const bool jumps = Jumps(before, now, dt_s);
  const bool too_fast = IsTooFast(before, now, dt_s);
  counters->jumps += jumps ? 1 : 0;
  counters->impossible_speeds += too_fast ? 1 : 0;
  if (jumps || too_fast) Doubt(trust, received.received);
}

void JudgeEchoes(std::span<const PeerView> views, const Situation& s, TrustCounters* counters) {
  if (s.run_state != RunState::kRunning) return;
  const std::uint32_t stands = TicksOf(kStands_s, s.options);
  const std::uint32_t closes = TicksOf(kCloses_s + 2 * Seconds(s.options.sonar_refresh), s.options);
  for (const PeerView& view : views) {
    PeerTrust& trust = view.peer->trust;
    if (!view.fresh) {
      trust.missing_ticks = trust.standing_ticks = trust.closing_ticks = 0;
      continue;
    }
    trust.missing_ticks = IsMissed(view, s) ? trust.missing_ticks + 1 : 0;
    if (trust.missing_ticks == kMissingTicks) ++counters->beacon_without_echo;
    // Ultrasonics that miss what is there, by its slant or by chance, accuse nobody.
    if (trust.missing_ticks >= kMissingTicks && !HasImperfectSonar(s.options)) Doubt(&trust, s.now);

    trust.standing_ticks = SaysItStands(view) ? trust.standing_ticks + 1 : 0;
    const bool closing = trust.standing_ticks > stands && ComesNearer(view, views, s);
    trust.closing_ticks = closing ? trust.closing_ticks + 1 : 0;
    if (trust.closing_ticks == closes) ++counters->halted_but_closing;
    if (trust.closing_ticks >= closes) Doubt(&trust, s.now);
  }
}

}  // namespace giveway
