// The period of a world's ticks, by what it says of its vehicles. Pure.
#pragma once

#include <algorithm>
#include <chrono>

#include "services/types/fleet_facts.h"
#include "services/types/time.h"

namespace giveway::link {

class TickPeriod {
 public:
  static constexpr Nanoseconds kMost = std::chrono::seconds(1);  // as of any scenario

  // In order of arrival. Ticks of one world are compared, whatever vehicles they are of.
  void Hear(const Truth& truth) {
    const bool later = truth.epoch == epoch_ && truth.tick > tick_ && truth.time_s > time_s_;
    if (later) {
      const double ticks = Number(truth.tick) - double(Number(tick_));
      const double period_s = std::min((truth.time_s - time_s_) / ticks, Seconds(kMost));
      period_ = FromSeconds(period_s);
    }
    epoch_ = truth.epoch;
    tick_ = truth.tick;
    time_s_ = truth.time_s;
  }
  Nanoseconds Get() const { return period_; }  // 0: not known

 private:
  WorldEpoch epoch_ = kNoEpoch;
  Tick tick_ = kNoTick;
  double time_s_ = 0;
  Nanoseconds period_{0};
};

}  // namespace giveway::link
