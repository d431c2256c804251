// The events of one tick, stamped as they happen; sequence numbers count through the epoch.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "services/types/fleet_facts.h"

namespace giveway::sim {

class EventLog {
 public:
  explicit EventLog(WorldEpoch epoch) : epoch_(epoch) {}

  // Forgets the last tick's events; what is added from now on happened at `tick`.
  void BeginTick(Tick tick, double time_s) {
    events_.clear();
    tick_ = tick;
    time_s_ = time_s;
  }
  // Sets seq, epoch, tick and time; the rest is the caller's.
  void Add(WorldEvent event) {
    event.seq = ++seq_;
    event.epoch = epoch_;
    event.tick = tick_;
    event.time_s = time_s_;
    events_.push_back(std::move(event));
  }
  std::span<const WorldEvent> Events() const { return events_; }

  // The number of the last event, 0 before the first.
  std::uint32_t Seq() const { return seq_; }
  // The next event follows number `seq` of the same epoch, which an earlier process logged.
  void ContinueFrom(std::uint32_t seq) { seq_ = seq; }

 private:
  WorldEpoch epoch_;
  std::uint32_t seq_ = 0;
  Tick tick_ = kNoTick;
  double time_s_ = 0;
  std::vector<WorldEvent> events_;
};

}  // namespace giveway::sim
