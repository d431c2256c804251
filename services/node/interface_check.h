// Whether a process can still be reached by the network interface it is bound to, looked at when it
// hears nothing: the library binds once, so that only a new process hears by another interface. No
// clock.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "services/types/time.h"

namespace giveway {

class InterfaceCheck {
 public:
  // `change`: what changed of the interfaces, in words; empty: nothing, or nothing that a new
  // process could do better with. May throw.
  explicit InterfaceCheck(std::function<std::string()> change) : change_(std::move(change)) {}

  // Once a turn; `heard`: a sample came. True if the process is to end, for its restart policy to
  // bring it back; the log says why.
  bool MustEnd(SteadyTime now, bool heard);

 private:
  std::function<std::string()> change_;
  SteadyTime last_heard_{0};
  SteadyTime next_check_{0};
};

}  // namespace giveway
