// Reports which faults of a schedule start and end as time advances: the supervisor's own time, or
// the world's, which stands while the world is gone. Injects none itself. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "services/faults/fault.h"

namespace giveway::fleetctl {

// The start or the end of a fault. An instantaneous fault has only a start.
struct FaultEdge {
  std::size_t fault = 0;  // index into the schedule
  double at_s = 0;        // since the start signal
  bool begins = true;

  friend bool operator==(const FaultEdge&, const FaultEdge&) = default;
};

class FaultClock {
 public:
  // Of those faults alone, or of all. `schedule` outlives this.
  explicit FaultClock(std::span<const faults::Fault> schedule,
                      const std::function<bool(const faults::Fault&)>& follows = {});

  // The edges that are due at `now_s` and were not returned before, in order of time. At equal
  // times ends come first.
  std::span<const FaultEdge> TakeDue(double now_s);
  // Ends every active fault now; no further one starts.
  std::span<const FaultEdge> EndAll(double now_s);
  // Indices of the active faults, ascending.
  std::vector<std::size_t> UnderWay() const;
  // When the last one ends; 0 if there is none.
  double LastEnd_s() const { return last_end_s_; }

 private:
  std::span<const faults::Fault> schedule_;
  std::vector<FaultEdge> edges_;
  std::size_t next_ = 0;
  std::vector<FaultEdge> early_ends_;
  double last_end_s_ = 0;
};

}  // namespace giveway::fleetctl
