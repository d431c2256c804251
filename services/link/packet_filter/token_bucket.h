// So many at once, and one more each so often. Pure.
#pragma once

#include <algorithm>
#include <cstdint>

#include "services/types/time.h"

namespace giveway::link {

class TokenBucket {
 public:
  TokenBucket(std::int64_t at_once, std::int64_t per_second)
      : most_(at_once),
        apart_(std::chrono::nanoseconds(std::chrono::seconds(1)) / per_second),
        left_(at_once) {}

  // False if none is left.
  bool Take(SteadyTime now) {
    if (due_ == SteadyTime{0}) due_ = now + apart_;
    if (now >= due_) {
      const std::int64_t due = 1 + (now - due_) / apart_;
      left_ = std::min(most_, left_ + std::min(due, most_));
      due_ += due * apart_;
    }
    if (left_ == 0) return false;
    --left_;
    return true;
  }

  void GiveBack() { left_ = std::min(most_, left_ + 1); }

 private:
  std::int64_t most_;
  Nanoseconds apart_;
  std::int64_t left_;
  SteadyTime due_{0};  // the next one
};

}  // namespace giveway::link
