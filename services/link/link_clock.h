// The clock by which the links watch the participants they receive: this machine's steady one.
#pragma once

#include <chrono>

#include "services/types/time.h"

namespace giveway::link {

inline SteadyTime LinkNow() {
  return SteadyTime(std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace giveway::link
