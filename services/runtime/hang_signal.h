// A drill: SIGUSR2 makes the control loop hang, and the next one makes it resume. The loop polls;
// the library's threads are not affected. Without this object SIGUSR2 ends the process, as is its
// default.
#pragma once

#include <csignal>

namespace giveway {

class HangSignal {
 public:
  // Handles SIGUSR2 while it lives. One at a time.
  HangSignal();
  ~HangSignal();
  HangSignal(const HangSignal&) = delete;
  HangSignal& operator=(const HangSignal&) = delete;

  // True from the first signal to the second. False where there is no such object.
  static bool IsUp();

 private:
  struct sigaction before_ {};
};

// As of a loop that really hangs: it does not see SIGTERM, which ends the process a second later.
void HangWhileUp();

}  // namespace giveway
