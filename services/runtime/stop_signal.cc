#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

#include "services/runtime/process.h"
#include "services/types/check.h"

namespace giveway {
namespace {

struct Handled {
  int signal_number;
  void (*handler)(int);
};

// Handlers run on any thread at any moment: lock-free atomics and async-signal-safe calls are all
// they may touch.
std::atomic<std::int64_t> asked_at_ns{0};  // 0: not yet
std::atomic<int> asked_by{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);
static_assert(std::atomic<int>::is_always_lock_free);
bool installed = false;

std::int64_t NowNs() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

[[noreturn]] void EndNow(int signal_number) { _exit(128 + signal_number); }

void OnStop(int signal_number) {
  const std::int64_t now_ns = NowNs();
  std::int64_t first_ns = 0;
  if (asked_at_ns.compare_exchange_strong(first_ns, now_ns)) {
    asked_by = signal_number;
    alarm(StopSignal::kLeave_s);
  } else if (now_ns - first_ns > StopSignal::kSameRequest.count()) {
    EndNow(signal_number);
  }
}

// The time to leave is over: the library hangs, or the loop does.
void OnTimeOver(int /*signal_number*/) { EndNow(asked_by); }

// A parent may have ignored SIGCHLD, which survives exec: then no child could be waited for.
const std::array<Handled, 6> kHandled{{{SIGINT, OnStop},
                                       {SIGTERM, OnStop},
                                       {SIGALRM, OnTimeOver},
                                       {SIGPIPE, SIG_IGN},
                                       {SIGXFSZ, SIG_IGN},
                                       {SIGCHLD, SIG_DFL}}};
std::array<struct sigaction, kHandled.size()> before;

// A process that restarted itself held its signals back until now.
void LetPass() {
  sigset_t ours;
  sigemptyset(&ours);
  for (const Handled& handled : kHandled) sigaddset(&ours, handled.signal_number);
  sigprocmask(SIG_UNBLOCK, &ours, nullptr);
}

}  // namespace

StopSignal::StopSignal() {
  GIVEWAY_CHECK(!installed);
  installed = true;
  asked_at_ns = 0;
  for (std::size_t i = 0; i < kHandled.size(); ++i) {
    struct sigaction action {};
    sigemptyset(&action.sa_mask);
    action.sa_handler = kHandled[i].handler;
    const int failed = sigaction(kHandled[i].signal_number, &action, &before[i]);
    GIVEWAY_CHECK(failed == 0, kHandled[i].signal_number);
  }
  LetPass();
}

StopSignal::~StopSignal() {
  alarm(0);
  for (std::size_t i = 0; i < kHandled.size(); ++i) {
    sigaction(kHandled[i].signal_number, &before[i], nullptr);
  }
  installed = false;
}

bool StopSignal::IsSet() const { return asked_at_ns != 0; }

}  // namespace giveway
