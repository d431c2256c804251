#include "services/fleetctl/process/interrupts.h"

#include <unistd.h>

#include <atomic>

namespace giveway::fleetctl {
namespace {

constexpr int kInterruptedCode = 1;  // the same as that of the verbs
constexpr int kFirstSignalCode = 128;
constexpr int kMostInterrupts = 2;
constexpr unsigned kLongestSilence_s = 1;

// Read by the verb's threads, written by whichever thread gets the signal.
std::atomic<int> interrupt_count{0};
std::atomic<int> first_signal{0};
std::atomic<bool> is_watched{false};
std::atomic<bool> exits_as_signal{false};
static_assert(std::atomic<int>::is_always_lock_free);
static_assert(std::atomic<bool>::is_always_lock_free);

void StartSecond() {
  if (is_watched) ::alarm(kLongestSilence_s);
}

int HardExitCode() { return exits_as_signal ? kFirstSignalCode + first_signal : kInterruptedCode; }

void CountInterrupt(int signal_number) {
  int none = 0;
  first_signal.compare_exchange_strong(none, signal_number);
  if (++interrupt_count > kMostInterrupts) ::_exit(HardExitCode());
  StartSecond();
}

void EndSilent(int /*signal_number*/) { ::_exit(HardExitCode()); }

}  // namespace

Interrupts::Interrupts(Silence silence, HardExit hard_exit) {
  interrupt_count = 0;
  first_signal = 0;
  exits_as_signal = hard_exit == HardExit::kAsSignal;
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

int Interrupts::SignalCode() { return kFirstSignalCode + first_signal; }

void Interrupts::AllowSeconds(unsigned seconds) {
  if (interrupt_count > 0 && is_watched) ::alarm(seconds);
}

}  // namespace giveway::fleetctl
