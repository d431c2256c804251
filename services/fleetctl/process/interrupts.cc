#include "services/fleetctl/process/interrupts.h"

#include <unistd.h>

#include <atomic>

namespace giveway::fleetctl {
namespace {

constexpr int kInterruptedCode = 1;  // the same as that of the verbs
constexpr int kMostInterrupts = 2;
constexpr unsigned kLongestSilence_s = 1;

// Read by the verb's threads, written by whichever thread gets the signal.
std::atomic<int> interrupt_count{0};
std::atomic<bool> is_watched{false};
static_assert(std::atomic<int>::is_always_lock_free);
static_assert(std::atomic<bool>::is_always_lock_free);

void StartSecond() {
  if (is_watched) ::alarm(kLongestSilence_s);
}

void CountInterrupt(int /*signal_number*/) {
  if (++interrupt_count > kMostInterrupts) ::_exit(kInterruptedCode);
  StartSecond();
}

void EndSilent(int /*signal_number*/) { ::_exit(kInterruptedCode); }

}  // namespace

Interrupts::Interrupts(Silence silence) {
  interrupt_count = 0;
  is_watched = silence == Silence::kHangs;
  struct sigaction end {};
  end.sa_handler = EndSilent;
  ::sigaction(SIGALRM, &end, &before_alarm_);
  struct sigaction count {};
  count.sa_handler = CountInterrupt;
  ::sigaction(SIGINT, &count, &before_int_);
  ::sigaction(SIGTERM, &count, &before_term_);
  ::sigaction(SIGHUP, &count, &before_hup_);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &ignore, &before_pipe_);
}

Interrupts::~Interrupts() {
  is_watched = false;
  ::alarm(0);
  ::sigaction(SIGALRM, &before_alarm_, nullptr);
  ::sigaction(SIGINT, &before_int_, nullptr);
  ::sigaction(SIGTERM, &before_term_, nullptr);
  ::sigaction(SIGHUP, &before_hup_, nullptr);
  ::sigaction(SIGPIPE, &before_pipe_, nullptr);
}

int Interrupts::Count() {
  const int count = interrupt_count;
  if (count > 0) StartSecond();
  return count;
}

void Interrupts::AllowSeconds(unsigned seconds) {
  if (interrupt_count > 0 && is_watched) ::alarm(seconds);
}

}  // namespace giveway::fleetctl
