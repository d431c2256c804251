#include "services/runtime/hang_signal.h"

#include <atomic>

#include "services/runtime/process.h"
#include "services/types/check.h"

namespace giveway {
namespace {

// The handler runs on any thread at any moment: a lock-free flag is all it may touch.
std::atomic<bool> is_up{false};
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr Nanoseconds kPoll = std::chrono::milliseconds(20);

void OnSignal(int /*signal*/) { is_up = !is_up; }

}  // namespace

HangSignal::HangSignal() {
  is_up = false;
  struct sigaction action {};
  sigemptyset(&action.sa_mask);
  action.sa_handler = OnSignal;
  const int failed = sigaction(SIGUSR2, &action, &before_);
  GIVEWAY_CHECK(failed == 0);
}

HangSignal::~HangSignal() {
  sigaction(SIGUSR2, &before_, nullptr);
  is_up = false;
}

bool HangSignal::IsUp() { return is_up; }

void HangWhileUp() {
  LogWarning("drill: the control loop hangs");
  while (HangSignal::IsUp()) SleepUntil(SteadyNow() + kPoll);
  LogWarning("drill: the control loop resumes");
}

}  // namespace giveway
