// Says which faults of a schedule start and end as time goes by. Makes nothing happen. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/faults/fault.h"

namespace giveway::fleetctl {

// One end of a fault. One that takes no time has a beginning alone.
struct FaultEdge {
  std::size_t fault = 0;  // index into the schedule
  double at_s = 0;        // since the start signal
  bool begins = true;

  friend bool operator==(const FaultEdge&, const FaultEdge&) = default;
};

class FaultClock {
 public:
  // `schedule` outlives this.
  explicit FaultClock(std::span<const faults::Fault> schedule);

  // Those that are due at `now_s` and were not given out before, in order of time. Of two at one
  // time the end comes first.
  std::span<const FaultEdge> TakeDue(double now_s);
  // Every fault that has started and not ended is to end now; none starts any more.
  std::span<const FaultEdge> EndAll(double now_s);
  // Indices of those under way, ascending.
  std::vector<std::size_t> UnderWay() const;
  // When the last one ends; 0 where there is none.
  double LastEnd_s() const { return last_end_s_; }

 private:
  std::span<const faults::Fault> schedule_;
  std::vector<FaultEdge> edges_;
  std::size_t next_ = 0;
  std::vector<FaultEdge> early_ends_;
  double last_end_s_ = 0;
};

}  // namespace giveway::fleetctl
