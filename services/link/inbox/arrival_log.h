// Counts the samples of each writer as they arrive, before a history keeps or overwrites them. This
// separates samples that never arrived from those that arrived and were overwritten. Written on the
// library's threads, read by the loop. For best-effort readers, which drop what arrives late.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>

#include "services/types/figures/beacon_account.h"

namespace giveway::link {

class ArrivalLog {
 public:
  static constexpr std::size_t kMostWriters = 2048;  // beyond, the oldest are forgotten
  // A writer that left is forgotten so many turns of the loop later, once its last samples were
  // taken.
  static constexpr std::uint64_t kTurnsToForget = 8;
  // Samples of a writer that are looked up while newer ones arrive: a second of beacons at 20 Hz.
  static constexpr std::size_t kKept = 20;

  // `sequence` is the library's number of the sample, `passed` what its filter said. One that does
  // not come after all before it is dropped by the library, and not counted here.
  void Note(std::uint64_t writer, std::uint64_t sequence, bool passed);
  // The counts as the sample arrived, without those of the loop; nothing of one that is not among
  // the writer's newest.
  std::optional<BeaconArrival> At(std::uint64_t writer, std::uint64_t sequence);
  // Once a turn of the loop: these writers have left. One that has spoken again until it would be
  // forgotten is kept.
  void NoteLeft(std::span<const std::uint64_t> writers);

 private:
  struct Writer {
    BeaconArrival newest;
    std::array<BeaconArrival, kKept> kept;  // a ring
    std::size_t next = 0;
  };

  struct Left {
    std::uint64_t writer = 0;
    std::uint64_t turn = 0;
    std::uint32_t arrived = 0;  // of it by then
  };

  void Forget(const Left& left);

  std::mutex mutex_;
  std::unordered_map<std::uint64_t, Writer> writers_;
  std::deque<std::uint64_t> oldest_;  // of writers_
  std::deque<Left> left_;             // each for kTurnsToForget
  std::uint64_t turn_ = 0;
};

}  // namespace giveway::link
