#include "services/runtime/crash_fallback.h"

#include <unistd.h>

#include <csignal>
#include <utility>
#include <vector>

#include "services/types/check.h"

namespace giveway {
namespace {

// All that a handler needs, made beforehand: it runs on any thread at any moment, and may neither
// allocate nor open anything.
struct Back {
  int signal_number;
  std::vector<std::string> arguments;
  std::vector<char*> words;  // of `arguments`
  struct sigaction before;
};
struct Prepared {
  std::vector<Back> backs;
  std::vector<int> held;
  const StopSignal* stop = nullptr;
};
Prepared prepared;
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
    for (const Back& back : prepared.backs) {
      if (back.signal_number == signal_number) execv("/proc/self/exe", back.words.data());
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

CrashFallback::CrashFallback(const std::vector<int>& signals, NewFlags flags, std::string why_flag,
                             const StopSignal& stop)
    : flags_(std::move(flags)), why_flag_(std::move(why_flag)) {
  GIVEWAY_CHECK(!is_installed);
  is_installed = true;
  const std::vector<std::string> own = OwnArguments();
  prepared = {{}, HeldDescriptors(), &stop};
  for (const int signal_number : signals) {
    const std::string why = "it ended by signal " + std::to_string(signal_number);
    prepared.backs.push_back({signal_number, ArgumentsWith(own, Because(why)), {}, {}});
  }
  for (Back& back : prepared.backs) {
    back.words = WordsOf(back.arguments);
    struct sigaction action {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_NODEFER;  // the next process image must not find its signal held back
    action.sa_handler = OnEnding;
    const int failed = sigaction(back.signal_number, &action, &back.before);
    GIVEWAY_CHECK(failed == 0, back.signal_number);
  }
}

CrashFallback::~CrashFallback() {
  for (const Back& back : prepared.backs) sigaction(back.signal_number, &back.before, nullptr);
  is_installed = false;
}

NewFlags CrashFallback::Because(const std::string& why) const {
  NewFlags flags = flags_;
  flags[why_flag_] = why;
  return flags;
}

}  // namespace giveway
