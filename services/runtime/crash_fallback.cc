#include "services/runtime/crash_fallback.h"

#include <unistd.h>

#include <array>
#include <csignal>
#include <utility>
#include <vector>

#include "services/types/check.h"

namespace giveway {
namespace {

constexpr std::array<int, 6> kEnding{SIGBUS, SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGSYS};

// All that a handler needs, made beforehand: it runs on any thread at any moment, and may neither
// allocate nor open anything.
struct Prepared {
  std::array<std::vector<std::string>, kEnding.size()> arguments;  // by signal
  std::array<std::vector<char*>, kEnding.size()> words;            // of `arguments`
  std::vector<int> held;
  const StopSignal* stop = nullptr;
};
Prepared prepared;
std::array<struct sigaction, kEnding.size()> actions_before;
bool is_installed = false;

// As LeaveOpenOnlyHeld: of `held`, in rising order, what is let go meanwhile closes by itself.
void CloseAllButHeld() {
  unsigned first = STDERR_FILENO + 1;
  for (const int descriptor : prepared.held) {
    const auto held = static_cast<unsigned>(descriptor);
    if (held > first) close_range(first, held - 1, CLOSE_RANGE_CLOEXEC);
    first = held + 1;
  }
  close_range(first, ~0U, CLOSE_RANGE_CLOEXEC);
}

void OnEnding(int signal_number) {
  if (!prepared.stop->IsSet()) {
    HoldSignalsBack();
    CloseAllButHeld();
    for (std::size_t i = 0; i < kEnding.size(); ++i) {
      if (kEnding[i] == signal_number) execv("/proc/self/exe", prepared.words[i].data());
    }
  }
  signal(signal_number, SIG_DFL);
  raise(signal_number);
}

std::vector<char*> WordsOf(std::vector<std::string>& arguments) {
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  return words;
}

}  // namespace

CrashFallback::CrashFallback(NewFlags flags, std::string why_flag, const StopSignal& stop)
    : flags_(std::move(flags)), why_flag_(std::move(why_flag)) {
  GIVEWAY_CHECK(!is_installed);
  is_installed = true;
  const std::vector<std::string> own = OwnArguments();
  for (std::size_t i = 0; i < kEnding.size(); ++i) {
    const std::string why = "it ended by signal " + std::to_string(kEnding[i]);
    prepared.arguments[i] = ArgumentsWith(own, Because(why));
    prepared.words[i] = WordsOf(prepared.arguments[i]);
  }
  prepared.held = HeldDescriptors();
  prepared.stop = &stop;
  for (std::size_t i = 0; i < kEnding.size(); ++i) {
    struct sigaction action {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_NODEFER;  // the next process image must not find its signal held back
    action.sa_handler = OnEnding;
    const int failed = sigaction(kEnding[i], &action, &actions_before[i]);
    GIVEWAY_CHECK(failed == 0, kEnding[i]);
  }
}

CrashFallback::~CrashFallback() {
  for (std::size_t i = 0; i < kEnding.size(); ++i)
    sigaction(kEnding[i], &actions_before[i], nullptr);
  is_installed = false;
}

NewFlags CrashFallback::Because(const std::string& why) const {
  NewFlags flags = flags_;
  flags[why_flag_] = why;
  return flags;
}

}  // namespace giveway
