#include "services/runtime/watchdog.h"

#include <execinfo.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "services/runtime/process.h"
#include "services/runtime/signals_blocked.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

constexpr Nanoseconds kWakeUp = milliseconds(100);
constexpr Nanoseconds kStackPatience = milliseconds(100);  // a thread
constexpr unsigned kWritingPatience_s = 2;                 // stderr may be a pipe that is not read
constexpr int kMostFrames = 64;

// The handler runs on any thread: a lock-free atomic, backtrace, which was loaded before, and write
// are all it touches.
std::atomic<int> stacks_written{0};

void WriteStack(int /*signal_number*/) {
  std::array<void*, kMostFrames> frames;
  const int count = backtrace(frames.data(), kMostFrames);
  backtrace_symbols_fd(frames.data(), count, STDERR_FILENO);
  ++stacks_written;
}

[[noreturn]] void EndOfPatience(int /*signal_number*/) { _exit(kWatchdogExit); }

void Handle(int signal_number, void (*handler)(int)) {
  struct sigaction action {};
  sigemptyset(&action.sa_mask);
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal_number, &action, nullptr);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal_number);
  pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
}

std::vector<pid_t> ThreadsOfProcess() {
  std::vector<pid_t> threads;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", error)) {
    const std::string name = entry.path().filename();
    pid_t thread = 0;
    std::from_chars(name.data(), name.data() + name.size(), thread);
    if (thread != 0) threads.push_back(thread);
  }
  return threads;
}

void Write(const std::string& text) {
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

void WriteAllStacks() {
  Handle(SIGRTMIN, WriteStack);
  for (const pid_t thread : ThreadsOfProcess()) {
    const int before = stacks_written;
    Write("thread " + std::to_string(thread) + (thread == getpid() ? ", the loop:\n" : ":\n"));
    syscall(SYS_tgkill, getpid(), thread, SIGRTMIN);
    const SteadyTime until = SteadyNow() + kStackPatience;
    while (stacks_written == before && SteadyNow() < until) {
      SleepUntil(SteadyNow() + milliseconds(1));
    }
    if (stacks_written == before) Write("  holds back all signals\n");
  }
}

Watchdog::Watchdog(Nanoseconds limit) : limit_(static_cast<std::uint64_t>(limit / kWakeUp)) {
  std::array<void*, 1> frame;
  backtrace(frame.data(), 1);  // loads what it needs, which a handler must not
  const SignalsBlocked blocked;
  thread_ = std::thread(&Watchdog::Watch, this);
}

Watchdog::~Watchdog() {
  ends_ = true;
  thread_.join();
}

void Watchdog::Watch() {
  std::uint64_t seen = 0;
  std::uint64_t silent = 0;
  while (!ends_) {
    SleepUntil(SteadyNow() + kWakeUp);
    const std::uint64_t turns = turns_.load(std::memory_order_relaxed);
    silent = turns == 0 || turns != seen ? 0 : silent + 1;
    seen = turns;
    if (silent < limit_) continue;
    Handle(SIGALRM, EndOfPatience);
    alarm(kWritingPatience_s);
    Write("watchdog: the control loop has made no progress for " +
          std::to_string(Seconds(kWakeUp) * static_cast<double>(silent)) +
          " s: this process ends itself with exit code " + std::to_string(kWatchdogExit) +
          "; where its threads are:\n");
    WriteAllStacks();
    _exit(kWatchdogExit);
  }
}

}  // namespace giveway
