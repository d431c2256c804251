// Counts the samples of each writer as they arrive, before a history keeps or overwrites them: this
// distinguishes what never arrived from what arrived and was overwritten. Written on the library's
// threads, read by the loop. For best-effort readers, which ignore late samples.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "services/types/figures/beacon_account.h"

namespace giveway::link {

class ArrivalLog {
 public:
  static constexpr std::size_t kMostWriters = 2048;  // beyond, the oldest are forgotten
  // Samples of a writer that are looked up while newer ones arrive: a second of beacons at 20 Hz.
  static constexpr std::size_t kKept = 20;

  // `sequence` is the library's number of the sample, `passed` what its filter said. One that does
  // not come after all before it is dropped by the library, and not counted here.
  void Note(std::uint64_t writer, std::uint64_t sequence, bool passed);
  // The counts as the sample arrived, without those of the loop; nothing of one that is not among
  // the writer's newest.
  std::optional<BeaconArrival> At(std::uint64_t writer, std::uint64_t sequence);

 private:
  struct Writer {
    BeaconArrival newest;
    std::array<BeaconArrival, kKept> kept;  // a ring
    std::size_t next = 0;
  };

  std::mutex mutex_;
  std::unordered_map<std::uint64_t, Writer> writers_;
  std::deque<std::uint64_t> oldest_;  // of writers_
};

}  // namespace giveway::link
