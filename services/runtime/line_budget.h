// So many lines a second for one kind of message, however many there are: a client that asks a
// thousand times does not flood the log. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "services/types/time.h"

namespace giveway {

class LineBudget {
 public:
  explicit LineBudget(std::uint32_t lines_a_second) : lines_(lines_a_second) {}

  // Whether one more may be written now; else it is counted.
  bool Take(SteadyTime now) {
    Begin(now);
    if (written_ == lines_) {
      ++left_out_;
      return false;
    }
    ++written_;
    return true;
  }
  // How many were left out in the second that is over, once; 0 while it lasts.
  std::uint32_t TakeLeftOut(SteadyTime now) {
    Begin(now);
    return std::exchange(left_out_before_, 0);
  }

 private:
  void Begin(SteadyTime now) {
    if (now < second_ends_) return;
    second_ends_ = now + FromSeconds(1);
    written_ = 0;
    left_out_before_ += std::exchange(left_out_, 0);
  }

  std::uint32_t lines_;
  SteadyTime second_ends_{0};
  std::uint32_t written_ = 0;
  std::uint32_t left_out_ = 0;
  std::uint32_t left_out_before_ = 0;
};

}  // namespace giveway
