// Reports which faults of a schedule start and end as time advances: the supervisor's own time, or
// the world's, which stands while the world is gone. Injects none itself. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "services/faults/fault.h"
#include "services/types/fleet_facts.h"
#include "services/types/time.h"

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
  // times ends come first. A fault does not end in the call in which it starts: its effect could
  // not be seen. That end, and what is due after it, waits for the next call.
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

// The world's own time, by its truths. It stands while the world is gone, and lags by that.
class WorldTime {
 public:
  // One that stands for longer is not waited for any more.
  static constexpr Nanoseconds kGone = std::chrono::seconds(60);

  void Follow(std::span<const Truth> truths, SteadyTime now);
  // The newest truth, and when it was received; absent before the first.
  const std::optional<Truth>& Newest() const { return newest_; }
  SteadyTime ReceivedAt() const { return received_at_; }
  // Since the start signal; 0 before it.
  double Now_s() const { return newest_ ? newest_->time_s : 0; }
  // When it last advanced.
  SteadyTime MovedAt() const { return moved_at_; }
  bool IsGone(SteadyTime now) const { return now - moved_at_ > kGone; }

 private:
  std::optional<Truth> newest_;
  SteadyTime received_at_{0};
  SteadyTime moved_at_{0};
};

}  // namespace giveway::fleetctl
