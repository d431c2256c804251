// Which samples of a reliable writer have come, as the library's reader knows it: all up to a
// number, and some beyond. What lies beyond a hole the library keeps until the hole is filled, and
// limits it for none of its own readers: a writer whose first sample never comes would fill its
// memory. Pure.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace giveway::link {

class ArrivalWindow {
 public:
  // Beyond a hole so many numbers, and so many bytes until there is none. The library asks its
  // writer again for what was not taken.
  static constexpr std::size_t kAhead = 256;
  static constexpr std::size_t kMostHeld = std::size_t{256} * 1024;
  // Of numbers that a GAP names the library keeps some 40 bytes each. Endpoints that come and go in
  // a burst leave thousands.
  static constexpr std::int64_t kGapAhead = 8192;

  // A sample: false if it lies too far beyond a hole.
  bool Take(std::int64_t number, std::size_t bytes);
  // Whether what a GAP says of numbers up to `last` lies near enough.
  bool MaySkip(std::int64_t first, std::int64_t last) const;
  // None of these will come.
  void Skip(std::int64_t first, std::int64_t last);
  // What the library acknowledges with an ACKNACK of that count: it has all up to `last`, and lacks
  // the next one. Where that lies behind what came by this account, and the library says it with
  // another count too, it has the last word: what came meanwhile it acknowledges the second time.
  void Acknowledge(std::int64_t last, std::uint32_t count);
  // A HEARTBEAT: there is none any more before `first`. The library reads those of rising counts.
  void Hear(std::int64_t first, std::uint32_t count);

 private:
  void Fill();

  std::int64_t unbroken_ = 0;    // all up to it came, or will not come
  std::bitset<kAhead> beyond_;   // of those that follow it: the first one is missing
  std::size_t held_ = 0;         // bytes
  std::uint32_t heartbeat_ = 0;  // the highest count
  std::int64_t behind_ = -1;     // what the library acknowledged last, if it was behind
  std::uint32_t behind_count_ = 0;
};

}  // namespace giveway::link
