// The last samples in memory, by time and limited in bytes. Pure.
#pragma once

#include <cstdint>
#include <deque>

#include "services/link/raw_link.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

class SampleRing {
 public:
  static constexpr std::uint64_t kMostBytes = 512ULL << 20U;

  explicit SampleRing(double last_s);

  // `now` is steady: a sample's own times are those of clocks that may be set back.
  void Add(link::RawSample sample, SteadyTime now);
  const std::deque<link::RawSample>& Samples() const { return samples_; }
  // Samples within the requested time that were dropped for lack of memory.
  std::uint64_t Dropped() const { return dropped_; }

 private:
  void DropFirst();

  const Nanoseconds last_;
  std::deque<link::RawSample> samples_;
  std::deque<SteadyTime> added_at_;  // of each sample
  std::uint64_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace giveway::fleetctl
