#include "services/fleetctl/process/child_process.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>

#include "services/runtime/hang_signal.h"

namespace giveway::fleetctl {
namespace {

constexpr int kKeptFd = 3;
constexpr int kCannotExec = 127;  // the code of a shell for a program it cannot start
constexpr std::size_t kLongestLine = 2000;

std::string ErrnoText() { return std::strerror(errno); }

struct Pipe {
  FileDescriptor read;
  FileDescriptor write;
};

Pipe MakePipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw StartError("cannot make a pipe: " + ErrnoText());
  Pipe pipe{FileDescriptor(ends[0]), FileDescriptor(ends[1])};
  ::fcntl(pipe.read.Get(), F_SETFL, O_NONBLOCK);
  return pipe;
}

// The folder of the configuration is no flag's twin.
constexpr std::string_view kNoTwin = "GIVEWAY_CONFIG_DIR=";
// What a service may get from fleetctl's environment. Everything else is passed by flags: a
// variable such as GIVEWAY_HEALTH_PORT or GIVEWAY_ID is meant for fleetctl itself, or for one
// service, and would be wrong for all of them at once.
constexpr std::array<std::string_view, 3> kHandedOn{
    "GIVEWAY_LOG_FORMAT=", "GIVEWAY_THREADS=", "GIVEWAY_PARTITION_FREE="};

// Points to texts that `command` and this process's environment keep.
std::vector<char*> EnvironmentOf(ChildCommand* command) {
  const auto is_handed_on = [&](std::string_view text) {
    const auto names = [text](std::string_view name) { return text.starts_with(name); };
    return names(kNoTwin) || (!command->flags_only && std::ranges::any_of(kHandedOn, names));
  };
  std::vector<char*> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text(*variable);
    if (!text.starts_with("GIVEWAY_") || is_handed_on(text)) variables.push_back(*variable);
  }
  for (std::string& variable : command->environment) variables.push_back(variable.data());
  variables.push_back(nullptr);
  return variables;
}

// Holds all signals of this thread back.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_{};
};

// Signal masks and ignored signals survive exec: the child must start with neither, but for what it
// lets pass itself. One that came since the fork must not find a handler of this process.
void ResetSignals(bool handles_stops) {
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGHUP, SIGQUIT, SIGALRM, SIGXFSZ, SIGCHLD}) {
    std::signal(number, SIG_DFL);
  }
  sigset_t blocked;
  sigemptyset(&blocked);
  if (handles_stops) {
    sigaddset(&blocked, SIGINT);
    sigaddset(&blocked, SIGTERM);
    sigaddset(&blocked, HangSignal::kHang);
    sigaddset(&blocked, HangSignal::kResume);
  }
  ::sigprocmask(SIG_SETMASK, &blocked, nullptr);
}

// Runs between fork and exec, in a process whose other threads are gone: system calls only.
[[noreturn]] void BecomeChild(char* const* words, char* const* environment, pid_t parent,
                              int output, const ChildCommand& command) {
  const int kept_fd = command.kept_fd;
  ResetSignals(command.handles_stops);
  // A process group of its own: Ctrl-C reaches fleetctl alone, which stops the fleet gracefully.
  ::setpgid(0, 0);
  DieWith(parent);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  if (kept_fd == kKeptFd) {
    ::fcntl(kept_fd, F_SETFD, 0);
  } else if (kept_fd >= 0) {
    ::dup2(kept_fd, kKeptFd);
  }
  // The library's sockets are not close-on-exec, and must not stay open in the children.
  ::close_range(kept_fd >= 0 ? kKeptFd + 1 : kKeptFd, UINT_MAX, 0);
  ::execve(words[0], words, environment);
  const char* reason = ::strerrordesc_np(errno);  // allocates nothing, takes no lock
  for (const char* part : {"cannot start ", static_cast<const char*>(words[0]), ": ", reason}) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, part, std::strlen(part));
  }
  ::_exit(kCannotExec);
}

// How a child ended; nothing while it runs. Never blocks. One that is no child any more has ended,
// too: where SIGCHLD is ignored the system reaps it, and its exit code is gone.
std::optional<ProcessEnd> ReapIfEnded(pid_t pid) {
  int status = 0;
  const pid_t reaped = ::waitpid(pid, &status, WNOHANG);
  if (reaped < 0 && errno == ECHILD) return ProcessEnd{false, ProcessEnd::kNotKnown};
  if (reaped != pid) return std::nullopt;
  if (WIFSIGNALED(status)) return ProcessEnd{true, WTERMSIG(status)};
  return ProcessEnd{false, WEXITSTATUS(status)};
}

}  // namespace

std::filesystem::path ProgramFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

void DieWith(pid_t parent) {
  // No other signal ends a process that is stopped, hangs, or handles it.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotExec);  // the parent died before the prctl
}

std::string Describe(ProcessEnd end) {
  if (end == ProcessEnd{false, ProcessEnd::kNotKnown}) return "exit code not known";
  if (!end.by_signal) return "exit code " + std::to_string(end.number);
  return "signal " + std::to_string(end.number) + " (" + ::strsignal(end.number) + ")";
}

ChildProcess::ChildProcess(const ChildCommand& command)
    : name_(command.name), hands_on_lines_(command.hands_on_lines) {
  if (!command.log_file.empty() && !log_.Open(command.log_file)) {
    throw StartError("cannot write " + command.log_file + ": " + ErrnoText());
  }
  ChildCommand own = command;
  std::vector<char*> argv;
  for (std::string& word : own.words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::vector<char*> environment = EnvironmentOf(&own);

  Pipe pipe = MakePipe();
  const pid_t parent = ::getpid();
  const SignalsHeld until_child_is_ready;
  pid_ = ::fork();
  if (pid_ < 0) throw StartError("cannot fork for " + name_ + ": " + ErrnoText());
  if (pid_ == 0) BecomeChild(argv.data(), environment.data(), parent, pipe.write.Get(), command);
  output_ = std::move(pipe.read);
}

ChildProcess::~ChildProcess() {
  if (!IsRunning()) return;
  Signal(SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void ChildProcess::Poll() {
  if (!IsRunning()) return;
  end_ = ReapIfEnded(pid_);
  if (hears_ || end_) ReadOutput();  // after waitpid: no output before the end is missed
  if (!end_) return;
  if (!unfinished_line_.empty()) KeepLines("\n", 1);
  log_.End();
}

bool ChildProcess::AnyHasEnded() {
  siginfo_t ended{};
  const int code = ::waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT);
  return code == 0 && ended.si_pid != 0;
}

void ChildProcess::Signal(int signal_number) {
  if (IsRunning()) ::kill(pid_, signal_number);
}

void ChildProcess::AskToStop() {
  if (!std::exchange(asked_to_stop_, true)) Signal(SIGTERM);
}

OutputFlow ChildProcess::Output() const {
  int unread = 0;
  if (::ioctl(output_.Get(), FIONREAD, &unread) != 0) unread = 0;
  return {bytes_read_, static_cast<std::uint64_t>(unread)};
}

void ChildProcess::ReadOutput() {
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t got = ::read(output_.Get(), buffer.data(), buffer.size());
    if (got <= 0) return;
    const auto size = static_cast<std::size_t>(got);
    bytes_read_ += size;
    log_.Append({buffer.data(), size});
    KeepLines(buffer.data(), size);
  }
}

void ChildProcess::KeepLines(const char* text, std::size_t size) {
  for (const char character : std::string_view(text, size)) {
    if (character != '\n') {
      if (unfinished_line_.size() < kLongestLine) unfinished_line_.push_back(character);
      continue;
    }
    if (hands_on_lines_) lines_.push_back(unfinished_line_);
    last_lines_.push_back(std::move(unfinished_line_));
    unfinished_line_.clear();
    if (last_lines_.size() > kLinesKept) last_lines_.pop_front();
  }
}

}  // namespace giveway::fleetctl
