#include <array>
#include <atomic>
#include <csignal>

#include "services/app/process.h"
#include "services/types/check.h"

namespace giveway::app {
namespace {

constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGPIPE};

// The handler runs on any thread at any moment: a lock-free flag is all it may touch.
std::atomic<bool> stop_set{false};
static_assert(std::atomic<bool>::is_always_lock_free);
bool installed = false;
std::array<struct sigaction, kSignals.size()> before;

void OnStop(int /*signal*/) { stop_set = true; }

// A process that restarted itself held its signals back until now.
void LetPass() {
  sigset_t ours;
  sigemptyset(&ours);
  for (const int number : kSignals) sigaddset(&ours, number);
  sigprocmask(SIG_UNBLOCK, &ours, nullptr);
}

}  // namespace

StopSignal::StopSignal() {
  GIVEWAY_CHECK(!installed);
  installed = true;
  stop_set = false;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action {};
    sigemptyset(&action.sa_mask);
    // A closed pipe is an error of the write that met it, not the end of the process.
    action.sa_handler = kSignals[i] == SIGPIPE ? SIG_IGN : OnStop;
    const int failed = sigaction(kSignals[i], &action, &before[i]);
    GIVEWAY_CHECK(failed == 0, kSignals[i]);
  }
  LetPass();
}

StopSignal::~StopSignal() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
  installed = false;
}

bool StopSignal::IsSet() const { return stop_set; }

}  // namespace giveway::app
