// When a vehicle that is matched with its world, and yet gets no scan, waits no longer: the library
// permanently ignores a writer after one sample with a sequence number far ahead, from any sender.
// Only a new participant receives again. Pure.
#pragma once

#include <chrono>

#include "services/types/time.h"

namespace giveway {

class ScanWatch {
 public:
  explicit ScanWatch(SteadyTime now) : begun_(now), since_(now) {}

  // Once a turn. `scan`: one came; `speaks`: the writer of its ranges is there and alive. True if a
  // new participant is due: at most once a minute where that did not help.
  bool Update(SteadyTime now, bool scan, bool speaks) {
    heard_ = heard_ || scan;
    if (scan || !speaks) since_ = now;
    if (now - since_ < kPatience) return false;
    return heard_ || now - begun_ >= kInVain;
  }

 private:
  static constexpr Nanoseconds kPatience = std::chrono::seconds(10);
  // Of a process that never got a scan: to start it has not helped.
  static constexpr Nanoseconds kInVain = std::chrono::seconds(60);

  SteadyTime begun_;
  SteadyTime since_;  // the last scan, or when the world was silent last
  bool heard_ = false;
};

}  // namespace giveway
