// What a soak shares with the processes whose system clock it steps: one file, mapped by both.
// Plain data; no functions.
#pragma once

#include <atomic>
#include <cstdint>

namespace giveway::fleetctl {

// The environment variable with the file's name, for a process with the preloaded library.
inline constexpr char kClockShiftVariable[] = "GIVEWAY_CLOCK_SHIFT";

struct ClockShift {
  std::atomic<std::int64_t> offset_s{
      0};  // added to the system clock; the monotonic clock is unchanged
  std::atomic<std::uint64_t> shifted{0};  // readings to which an offset other than 0 was added
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free && sizeof(ClockShift) == 16);

}  // namespace giveway::fleetctl
