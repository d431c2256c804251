// A soak cut into blocks of time of equal length. What happens within one may have a single cause:
// for a comparison of two soaks each block counts as one observation, however many values it has.
// Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace giveway::fleetctl {

inline constexpr std::size_t kSoakBlocks = 20;

inline double BlockSeconds(double duration_s) {
  return duration_s / static_cast<double>(kSoakBlocks);
}

// What comes before the start belongs to the first block, what comes after the end to the last.
inline std::size_t BlockOf(double time_s, double block_s) {
  if (!(block_s > 0)) return 0;
  const double block = std::clamp(time_s / block_s, 0.0, static_cast<double>(kSoakBlocks - 1));
  return static_cast<std::size_t>(block);
}

// Events by block, up to the last block that has any.
class BlockCounts {
 public:
  explicit BlockCounts(double block_s) : block_s_(block_s) {}

  void Note(double time_s, std::uint64_t events) {
    if (events == 0 || !(block_s_ > 0)) return;
    const std::size_t block = BlockOf(time_s, block_s_);
    if (counts_.size() <= block) counts_.resize(block + 1);
    counts_[block] += events;
  }
  const std::vector<std::uint64_t>& Counts() const { return counts_; }

 private:
  double block_s_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace giveway::fleetctl
