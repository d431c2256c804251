// A drill: SIGUSR2 says that the control loop is to hang, and the next one that it may go on. The
// loop asks; the library's threads never know. Without this object SIGUSR2 ends the process, as
// ever.
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
