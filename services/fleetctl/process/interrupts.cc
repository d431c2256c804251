#include "services/fleetctl/process/interrupts.h"

#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cstring>

namespace giveway::fleetctl {
namespace {

constexpr int kInterruptedCode = 1;  // the same as that of the verbs
constexpr int kFirstSignalCode = 128;
constexpr int kMostInterrupts = 2;
constexpr unsigned kLongestSilence_s = 1;  // unless the verb asks for more

// Read by the verb's threads, written by whichever thread gets the signal.
std::atomic<int> interrupt_count{0};
std::atomic<int> first_signal{0};
std::atomic<bool> is_watched{false};
std::atomic<unsigned> longest_silence_s{kLongestSilence_s};
std::atomic<bool> exits_as_signal{false};
std::atomic<const char*> last_output{nullptr};
static_assert(std::atomic<int>::is_always_lock_free);
static_assert(std::atomic<const char*>::is_always_lock_free);
static_assert(std::atomic<bool>::is_always_lock_free);
static_assert(std::atomic<unsigned>::is_always_lock_free);

void StartSilence() {
  if (is_watched) ::alarm(longest_silence_s);
}

int HardExitCode() { return exits_as_signal ? kFirstSignalCode + first_signal : kInterruptedCode; }

// Of a signal handler: system calls only. Not where it would wait for a terminal that is stopped,
// or for who does not read a pipe.
void Write(int descriptor, const char* text) {
  pollfd there{descriptor, POLLOUT, 0};
  if (::poll(&there, 1, 0) != 1 || (there.revents & POLLOUT) == 0) return;
  [[maybe_unused]] const ssize_t written = ::write(descriptor, text, std::strlen(text));
}

[[noreturn]] void EndHard(const char* why) {
  if (const char* text = last_output) Write(STDOUT_FILENO, text);
  Write(STDERR_FILENO, why);
  ::_exit(HardExitCode());
}

void CountInterrupt(int signal_number) {
  int none = 0;
  first_signal.compare_exchange_strong(none, signal_number);
  if (++interrupt_count > kMostInterrupts) {
    EndHard("ended at once; what was being written is not whole\n");
  }
  StartSilence();
}

void EndSilent(int /*signal_number*/) {
  EndHard(
      "interrupted, it did not stop in time and was ended; what was being written is not whole\n");
}

}  // namespace

Interrupts::Interrupts(Silence silence, HardExit hard_exit) {
  interrupt_count = 0;
  first_signal = 0;
  longest_silence_s = kLongestSilence_s;
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
  if (count > 0) StartSilence();
  return count;
}

int Interrupts::SignalCode() { return kFirstSignalCode + first_signal; }

void Interrupts::AllowSeconds(unsigned seconds) {
  longest_silence_s = seconds;
  if (interrupt_count > 0) StartSilence();
}

void Interrupts::WriteIfEnded(const char* text) { last_output = text; }

}  // namespace giveway::fleetctl
