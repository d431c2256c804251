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

struct QosCounters {
  std::uint32_t deadline_missed = 0;
  std::uint32_t liveliness_lost = 0;
  std::uint32_t incompatible_qos = 0;
  std::uint32_t matched = 0;
  std::uint32_t unmatched = 0;
};

}  // namespace giveway
