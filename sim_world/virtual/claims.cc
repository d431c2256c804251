#include "sim_world/virtual/claims.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/types/time.h"

namespace giveway::sim {
namespace {

// Rounding, and how far a tick of turning bends a straight stopping path.
constexpr double kClaimSlack_m = 0.01;

bool Holds(const Claim& claim, double body_radius_m, double slack_m, Vec2 centre_world) {
  const Vec2 offset = centre_world - claim.axis.from_world;
  const double along_m = std::clamp(Dot(offset, claim.axis.direction_world), 0.0, claim.length_m);
  const Vec2 beside = offset - along_m * claim.axis.direction_world;
  const double room_m = claim.radius_m - body_radius_m + slack_m;
  return SquaredNorm(beside) <= room_m * room_m;
}

}  // namespace

Claims::Claims(const Scenario& scenario) : dt_s_(Seconds(scenario.tick_period)) {
  for (const VehicleOptions& options : scenario.vehicles) {
    const auto lasts_ticks = static_cast<std::uint32_t>(ClaimLasts(options) / scenario.tick_period);
    oldest_ticks_ = std::max(oldest_ticks_, lasts_ticks);
  }
  for (const VehicleOptions& options : scenario.vehicles) {
    const std::uint32_t fresh = TicksCovering(options.beacon_age_limit, scenario.tick_period);
    fresh_ticks_ = std::clamp<std::uint32_t>(fresh + 1, fresh_ticks_, oldest_ticks_);
    tracks_.push_back({.deceleration_m_s2 = options.profile.deceleration_m_s2,
                       .reaction_s = 2 * dt_s_ + Seconds(options.sonar_refresh),
                       .said = std::vector<SentBeacon>(oldest_ticks_ + 1)});
  }
}

Claims::SentBeacon Claims::Keep(const Beacon& beacon) {
  const double heading_rad = beacon.world_from_body.heading_rad;
  const Twist twist = TwistFromWheels(beacon.drive, beacon.wheels);
  return {.beacon = beacon,
          .course = {.forward_world = {Cos(heading_rad), Sin(heading_rad)},
                     .speed_m_s = twist.forward_m_s,
                     .turn_rad_s = twist.turn_rad_s},
          .slack_m = kClaimSlack_m + kPoseSigmas * SigmaPosition(beacon.covariance)};
}

const Claims::SentBeacon* Claims::SaidBefore(Tick tick, std::uint32_t ago, const Track& track) {
  if (Number(tick) <= ago) return nullptr;
  const SentBeacon& said = track.said[(Number(tick) - ago) % track.said.size()];
  const Tick then = said.beacon.tick;
  return then != kNoTick && TicksBetween(then, tick) == ago ? &said : nullptr;
}

// Of old beacons not every one: one that leaves their claims does so for some ticks.
std::uint32_t Claims::Step(std::uint32_t ago) const { return ago < fresh_ticks_ ? 1 : 3; }

bool Claims::StaysInAll(Tick tick, const Observed& now, const Track& track) const {
  const double pace = Magnitude(now.forward_m_s);
  const double braking_m = now.forward_m_s * pace / (2 * track.deceleration_m_s2);
  const Vec2 stands_world =
      now.position_world + braking_m * Vec2{Cos(now.heading_rad), Sin(now.heading_rad)};
  for (std::uint32_t ago = 2; ago <= oldest_ticks_; ago += Step(ago)) {
    const SentBeacon* said = SaidBefore(tick, ago, track);
    if (said == nullptr) continue;
    const Claim claim = ClaimOf(said->beacon, said->course, ago * dt_s_, track.reaction_s);
    const double radius_m = said->beacon.body_radius_m;
    if (!Holds(claim, radius_m, said->slack_m, now.position_world) ||
        !Holds(claim, radius_m, said->slack_m, stands_world)) {
      return false;
    }
  }
  return true;
}

// Asked to stop in a tick, it brakes from the next on; peers use its beacon of the tick before.
bool Claims::StaysWhileBraking(Tick tick, const Observed& now, Track* track) const {
  if (!now.stops || !now.lives) {
    track->braking.reset();
    return true;
  }
  if (!track->braking) {
    const SentBeacon* said = SaidBefore(tick, 1, *track);
    if (said == nullptr) return true;
    track->braking = ClaimOf(said->beacon, said->course, 2 * dt_s_, track->reaction_s);
    track->braking_slack_m = said->slack_m;
  }
  return Holds(*track->braking, now.beacon->body_radius_m, track->braking_slack_m,
               now.position_world);
}

std::span<const std::uint32_t> Claims::Observe(Tick tick, std::span<const Observed> vehicles) {
  left_.clear();
  if (vehicles.size() != tracks_.size()) return left_;
  for (std::uint32_t i = 0; i < vehicles.size(); ++i) {
    const Observed& now = vehicles[i];
    Track& track = tracks_[i];
    if (now.beacon == nullptr) continue;
    const bool inside =
        !now.present || (StaysWhileBraking(tick, now, &track) && StaysInAll(tick, now, track));
    if (!inside && !track.reported) left_.push_back(i);
    track.reported = !inside;
    if (now.lives && now.beacon->tick == tick)
      track.said[Number(tick) % track.said.size()] = Keep(*now.beacon);
  }
  return left_;
}

}  // namespace giveway::sim
