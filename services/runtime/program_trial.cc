#include "services/runtime/program_trial.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <vector>

#include "services/runtime/process.h"

namespace giveway {
namespace {

constexpr std::size_t kMostSaid = 4096;
constexpr int kHeld = 3;  // the descriptor of the text, in the process that tries it

[[noreturn]] void Throw(int error, const char* what) {
  throw std::system_error(error, std::generic_category(), what);
}

std::string HowItEnded(int status) {
  if (WIFSIGNALED(status)) return "it ended by signal " + std::to_string(WTERMSIG(status));
  return "it ended with exit code " + std::to_string(WEXITSTATUS(status));
}

// What the process starts with: the text, a pipe for what it says, and nothing else of this one's.
class Inheritance {
 public:
  Inheritance(int text, int output) {
    posix_spawn_file_actions_init(&files_);
    posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files_, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files_, text, kHeld);
    posix_spawn_file_actions_addclosefrom_np(&files_, kHeld + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t signals;
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~Inheritance() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  Inheritance(const Inheritance&) = delete;
  Inheritance& operator=(const Inheritance&) = delete;

  pid_t Spawn(std::vector<std::string> arguments) {
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    pid_t process = -1;
    const int error =
        posix_spawn(&process, "/proc/self/exe", &files_, &attributes_, words.data(), environ);
    if (error != 0) Throw(error, "cannot start a second process");
    return process;
  }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

ProgramTrial::ProgramTrial(NewFlags flags, const std::string& name, const std::string& file_name,
                           const std::string& text, Nanoseconds patience)
    : until_(SteadyNow() + patience) {
  flags[name] = "/proc/self/fd/" + std::to_string(kHeld);
  const HeldText held(file_name, text);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) Throw(errno, "cannot make a pipe");
  output_ = ends[0];
  try {
    process_ = Inheritance(held.Descriptor(), ends[1]).Spawn(ArgumentsWith(OwnArguments(), flags));
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
}

ProgramTrial::~ProgramTrial() {
  Kill();
  close(output_);
}

void ProgramTrial::Kill() {
  if (process_ < 0) return;
  kill(process_, SIGKILL);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
}

void ProgramTrial::Read() {
  std::array<char, 1024> part{};
  for (ssize_t count = 1; count > 0;) {
    count = read(output_, part.data(), part.size());
    if (count > 0 && said_.size() < kMostSaid) {
      said_.append(part.data(), static_cast<std::size_t>(count));
    }
  }
}

std::optional<std::string> ProgramTrial::Result() {
  if (result_) return result_;
  Read();
  int status = 0;
  const pid_t ended = waitpid(process_, &status, WNOHANG);
  if (ended == process_) {
    process_ = -1;
    Read();
    while (said_.ends_with('\n')) said_.pop_back();
    const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    result_ = good ? "" : said_.empty() ? HowItEnded(status) : said_;
  } else if (SteadyNow() >= until_) {
    Kill();
    result_ = "it did not end in time";
  }
  return result_;
}

}  // namespace giveway
