// Graded trust: what a peer says, held against what it said before (here) and against the own
// ultrasonics (situation/echo_trust.h).
// What does not fit is counted by kind (TrustCounters), and the peer is doubted for a while.
//
// Doubt only removes privileges. While a peer is doubted, its grants, its red light, its standing
// and its explanation of an echo do not count; and while one is near, the vehicle goes by its own
// ranges (sensor_only). Its claim is still kept clear of: it may be where it says it is. Doubt
// never makes a vehicle less careful, so a forged doubt can only slow others down.
#pragma once

#include <cstdint>

#include "services/types/beacon.h"
#include "services/types/counters.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// What a vehicle holds against one peer.
struct PeerTrust {
  bool ever_doubted = false;
  SteadyTime doubted_at{0};          // the last time, if ever
  std::uint32_t missing_ticks = 0;   // in a row that a sensor which must have heard it did not
  std::uint32_t standing_ticks = 0;  // in a row that it says it stands
  std::uint32_t closing_ticks = 0;   // of these, in a row, that its echo came nearer all the same
};

// Long enough to stand before it ends, at any speed of this fleet; short enough that an honest peer
// that met with an accident of sensing is soon believed again.
inline constexpr Nanoseconds kDoubtLasts{2'000'000'000};

inline bool IsDoubted(const PeerTrust& trust, SteadyTime now) {
  return trust.ever_doubted && now - trust.doubted_at <= kDoubtLasts;
}

inline void Doubt(PeerTrust* trust, SteadyTime now) {
  trust->ever_doubted = true;
  trust->doubted_at = now;
}

// Beyond which errors of a pose are no errors any more, in standard deviations of each pose.
inline constexpr double kErrorSigmas = 3;
// On top of that: slip within a tick, speeding up since the beacon.
inline constexpr double kPoseSlack_m = 0.1;

// A beacon against the one accepted before it, both of one life: did it jump, or drive faster than
// it, or any vehicle, can?
void JudgeBeacon(const Beacon& before, const ReceivedBeacon& received,
                 const VehicleOptions& options, PeerTrust* trust, TrustCounters* counters);

}  // namespace giveway
