#include "services/vehicle/estimation/trust.h"

#include <algorithm>

#include "services/types/fleet_limits.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

// What encoders and slip may add to a speed, as a share of it.
constexpr double kSpeedSlack = 1.5;
constexpr double kGain_m_s = 0.1;  // and to what is gained from one beacon to the next

double Pace(const Beacon& beacon) {
  return Magnitude(TwistFromWheels(beacon.drive, beacon.wheels).forward_m_s);
}

// Further than it could have driven.
bool Jumps(const Beacon& before, const Beacon& now, double dt_s) {
  const double fastest = kSpeedSlack * std::max({Pace(before), Pace(now), now.cruise_m_s});
  const double sure_m = fastest * dt_s + kPoseSlack_m;
  const Vec2 displacement =
      now.world_from_body.position_world - before.world_from_body.position_world;
  if (SquaredNorm(displacement) <= sure_m * sure_m)
    return false;  // nearly all, for none of the roots below
  const double most_m =
      sure_m + kErrorSigmas * (SigmaPosition(before.covariance) + SigmaPosition(now.covariance));
  return SquaredNorm(displacement) > most_m * most_m;
}

// Faster than any vehicle of this fleet, or accelerated more than it says it can.
bool IsTooFast(const Beacon& before, const Beacon& now, double dt_s) {
  const double pace = Pace(now);
  if (pace > kMaxSpeed_m_s) return true;
  // A wheel that stops rolling backwards speeds the body up, and it may do that by braking.
  const double rate_m_s2 = std::max(now.acceleration_m_s2, now.deceleration_m_s2);
  return pace > kSpeedSlack * (Pace(before) + rate_m_s2 * dt_s) + kGain_m_s;
}

}  // namespace

void JudgeBeacon(const Beacon& before, const ReceivedBeacon& received,
                 const VehicleOptions& options, PeerTrust* trust, TrustCounters* counters) {
  const Beacon& now = received.beacon;
  // After a silence, or after its tick count restarted: there is nothing to compare with.
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

}  // namespace giveway
