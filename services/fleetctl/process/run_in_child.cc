#include "services/fleetctl/process/run_in_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "services/fleetctl/process/child_process.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

[[noreturn]] void WriteAndExit(const std::string& text, int pipe_end) {
  std::size_t sent = 0;
  while (sent < text.size()) {
    const ssize_t count = ::write(pipe_end, text.data() + sent, text.size() - sent);
    if (count < 0 && errno != EINTR) break;
    sent += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  ::_exit(0);  // the library's exit handlers may wait for threads that fork() did not copy
}

// Until the other end is closed, or `limit`.
std::string ReadAll(int pipe_end, SteadyTime limit) {
  std::string text;
  std::array<char, 4096> part{};
  while (true) {
    pollfd end{pipe_end, POLLIN, 0};
    const double left_ms = Milliseconds(limit - SteadyNow());
    if (left_ms <= 0) return text;
    const int ready = ::poll(&end, 1, static_cast<int>(left_ms) + 1);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return text;
    const ssize_t count = ::read(pipe_end, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

ChildResult RunInChild(const std::function<std::string()>& work, Nanoseconds patience) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw StartError(std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  const FileDescriptor reading(ends[0]);
  FileDescriptor writing(ends[1]);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw StartError(std::string("cannot fork: ") + std::strerror(errno));
  if (child == 0) {
    DieWith(parent);
    WriteAndExit(work(), writing.Get());
  }
  writing.Close();
  ChildResult answer{ReadAll(reading.Get(), SteadyNow() + patience)};
  ::kill(child, SIGKILL);  // nothing to one that has ended and is not waited for yet
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  answer.whole = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return answer;
}

}  // namespace giveway::fleetctl
