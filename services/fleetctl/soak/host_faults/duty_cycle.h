// When a process that gets a share of the time runs and when it is stopped: as evenly as the caller
// looks, and the share itself over any longer time, however late single looks are.
#pragma once

#include "services/types/time.h"

namespace giveway::fleetctl {

class DutyCycle {
 public:
  // `share` of the time, 0 to 1, from `now` on. It runs first.
  DutyCycle(double share, SteadyTime now) : share_(share), looked_(now) {}

  // Whether it is stopped from `now` until the next look.
  bool IsStoppedFrom(SteadyTime now) {
    const double gone_s = Seconds(now - looked_);
    looked_ = now;
    credit_s_ += share_ * gone_s - (stopped_ ? 0 : gone_s);
    stopped_ = credit_s_ < 0;
    return stopped_;
  }

 private:
  double share_;
  SteadyTime looked_;
  double credit_s_ = 0;  // for which it may still run; negative: it ran for longer than its share
  bool stopped_ = false;
};

}  // namespace giveway::fleetctl
