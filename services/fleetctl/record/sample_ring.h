// The last samples in memory, by time and limited in bytes. Pure.
#pragma once

#include <cstdint>
#include <deque>

#include "services/link/raw_link.h"

namespace giveway::fleetctl {

class SampleRing {
 public:
  static constexpr std::uint64_t kMostBytes = 512ULL << 20U;

  explicit SampleRing(double last_s);

  void Add(link::RawSample sample);
  const std::deque<link::RawSample>& Samples() const { return samples_; }
  // Samples within the requested time that were dropped for lack of memory.
  std::uint64_t Dropped() const { return dropped_; }

 private:
  void DropFirst();

  const std::uint64_t last_ns_;
  std::deque<link::RawSample> samples_;
  std::uint64_t bytes_ = 0;
  std::uint64_t newest_ns_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace giveway::fleetctl
