// What a vehicle counts about its peers. Every beacon taken is counted exactly once:
//   taken = accepted + not_heard + the rejections.
// superseded and lost are gaps in a peer's sequence numbers that were overwritten in the reader
// before the loop drained it, or never came.
#pragma once

#include <cstdint>

namespace giveway {

struct BeaconCounters {
  std::uint32_t sent = 0;
  std::uint32_t taken = 0;
  std::uint32_t accepted = 0;
  std::uint32_t not_heard = 0;  // from beyond the emission radius, or before a world was heard
  std::uint32_t lost = 0;       // sequence numbers that never arrived
  std::uint32_t rejected_not_finite = 0;
  std::uint32_t rejected_out_of_range = 0;
  std::uint32_t rejected_crc = 0;
  std::uint32_t rejected_replayed = 0;  // old or repeated sequence number
  std::uint32_t rejected_own = 0;
  std::uint32_t rejected_wrong_name = 0;
  std::uint32_t rejected_duplicate_id = 0;  // two writers speak for one id
  std::uint32_t rejected_wrong_epoch = 0;
  std::uint32_t rejected_table_full = 0;

  constexpr std::uint32_t Rejected() const {
    return rejected_not_finite + rejected_out_of_range + rejected_crc + rejected_replayed +
           rejected_own + rejected_wrong_name + rejected_duplicate_id + rejected_wrong_epoch +
           rejected_table_full;
  }
};

// What did not fit, by kind (services/vehicle/estimation/trust.h). The first three count its
// beginnings, whatever it lasts; the others each beacon. All wrap at 2^32, which takes years.
struct TrustCounters {
  std::uint32_t beacon_without_echo = 0;  // a body was said to be where the ultrasonics hear none
  std::uint32_t echo_without_beacon = 0;  // something near moved by itself, without a beacon
  std::uint32_t halted_but_closing = 0;   // said it stood, and its echo came nearer by itself
  std::uint32_t jumps = 0;                // further from the beacon before than it could have come
  std::uint32_t impossible_speeds = 0;    // faster than any vehicle, or than it could have become

  constexpr TrustCounters& operator+=(const TrustCounters& more) {
    beacon_without_echo += more.beacon_without_echo;
    echo_without_beacon += more.echo_without_beacon;
    halted_but_closing += more.halted_but_closing;
    jumps += more.jumps;
    impossible_speeds += more.impossible_speeds;
    return *this;
  }
  constexpr std::uint32_t Total() const {
    return beacon_without_echo + echo_without_beacon + halted_but_closing + jumps +
           impossible_speeds;
  }
};

// Samples that arrived and were not used, apart from beacons that the brain rejected.
struct RefusedSamples {
  std::uint32_t unbound_samples = 0;     // writer's partition not yet known
  std::uint32_t unreadable_samples = 0;  // arrived, but with values that cannot be converted
  std::uint32_t wrong_name_scans = 0;    // of a sensor, whose id is not this vehicle's
  std::uint32_t old_world_entries = 0;   // roster of a world while another one is believed
  std::uint32_t strangers = 0;           // of a participant that may not say that
  std::uint32_t implausible = 0;         // of the world, out of range or of ticks to come

  friend constexpr bool operator==(const RefusedSamples&, const RefusedSamples&) = default;
};

struct QosCounters {
  std::uint32_t deadline_missed = 0;
  std::uint32_t liveliness_lost = 0;
  std::uint32_t incompatible_qos = 0;
  std::uint32_t matched = 0;
  std::uint32_t unmatched = 0;
};

}  // namespace giveway
