// A drill: SIGUSR1 makes the control loop hang, SIGUSR2 makes it resume. The loop polls; the
// library's threads are not affected. Without this object both end the process, as is their
// default; but in one that was started with them held back they wait for it.
#pragma once

#include <csignal>

namespace giveway {

class HangSignal {
 public:
  static constexpr int kHang = SIGUSR1;
  static constexpr int kResume = SIGUSR2;

  // Handles both while it lives, in the order in which they wait. One at a time.
  HangSignal();
  ~HangSignal();
  HangSignal(const HangSignal&) = delete;
  HangSignal& operator=(const HangSignal&) = delete;

  // False where there is no such object.
  static bool IsUp();

 private:
  struct sigaction hang_before_ {};
  struct sigaction resume_before_ {};
};

// As of a loop that really hangs: it does not see SIGTERM, which ends the process a second later.
void HangWhileUp();

}  // namespace giveway
