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

void OnSignal(int signal) { is_up = signal == HangSignal::kHang; }

sigset_t Both() {
  sigset_t both;
  sigemptyset(&both);
  sigaddset(&both, HangSignal::kHang);
  sigaddset(&both, HangSignal::kResume);
  return both;
}

}  // namespace

HangSignal::HangSignal() {
  is_up = false;
  struct sigaction action {};
  // Of two that wait the lower number, the hang, is handled to its end first.
  action.sa_mask = Both();
  action.sa_handler = OnSignal;
  GIVEWAY_CHECK(sigaction(kHang, &action, &hang_before_) == 0);
  GIVEWAY_CHECK(sigaction(kResume, &action, &resume_before_) == 0);
  const sigset_t both = Both();
  pthread_sigmask(SIG_UNBLOCK, &both, nullptr);
}

HangSignal::~HangSignal() {
  sigaction(kHang, &hang_before_, nullptr);
  sigaction(kResume, &resume_before_, nullptr);
  is_up = false;
}

bool HangSignal::IsUp() { return is_up; }

void HangWhileUp() {
  LogWarning("drill: the control loop hangs");
  while (HangSignal::IsUp()) SleepUntil(SteadyNow() + kPoll);
  LogWarning("drill: the control loop resumes");
}

}  // namespace giveway
