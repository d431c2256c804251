// What a soak and the processes whose system clock it steps share: one file, mapped by both. Plain
// data; no functions.
#pragma once

#include <atomic>
#include <cstdint>

namespace giveway::fleetctl {

// Names the file to a process that is started with the preloaded library.
inline constexpr char kClockShiftVariable[] = "GIVEWAY_CLOCK_SHIFT";

struct ClockShift {
  std::atomic<std::int64_t> offset_s{0};  // added to what the system clock says; monotonic is left
  std::atomic<std::uint64_t> shifted{0};  // readings that an offset other than 0 was added to
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free && sizeof(ClockShift) == 16);

}  // namespace giveway::fleetctl
