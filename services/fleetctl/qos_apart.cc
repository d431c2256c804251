#include "services/fleetctl/qos_apart.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <string>

#include "services/fleetctl/child_process.h"

namespace giveway::fleetctl {
namespace {

constexpr char kComplaint = '!';  // begins the message of an error

// One line a value, tab between its parts; names have neither.
std::string Told(const link::LinkOptions& options) {
  try {
    std::ostringstream text;
    for (const link::ResolvedEntity& entity : link::ResolveQos(options)) {
      for (const link::ResolvedValue& value : entity.values) {
        text << entity.profile << '\t' << entity.topic << '\t' << value.policy << '\t'
             << value.number << '\n';
      }
    }
    return text.str();
  } catch (const std::exception& error) {
    return kComplaint + std::string(error.what());
  }
}

[[noreturn]] void TellAndExit(const link::LinkOptions& options, int pipe_end) {
  const std::string text = Told(options);
  std::size_t sent = 0;
  while (sent < text.size()) {
    const ssize_t count = write(pipe_end, text.data() + sent, text.size() - sent);
    if (count < 0 && errno != EINTR) break;
    sent += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  _exit(0);  // the library's own goodbye may hang on threads that a fork did not copy
}

std::string ReadAll(int pipe_end) {
  std::string text;
  char part[4096];
  while (true) {
    const ssize_t count = read(pipe_end, part, sizeof(part));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(part, static_cast<std::size_t>(count));
  }
}

std::vector<link::ResolvedEntity> Understood(const std::string& text) {
  std::vector<link::ResolvedEntity> entities;
  std::istringstream lines(text);
  std::string profile, topic, policy, number;
  while (std::getline(lines, profile, '\t') && std::getline(lines, topic, '\t') &&
         std::getline(lines, policy, '\t') && std::getline(lines, number)) {
    if (entities.empty() || entities.back().profile != profile) {
      entities.push_back({profile, topic, {}});
    }
    entities.back().values.push_back({policy, std::stoll(number)});
  }
  return entities;
}

}  // namespace

std::vector<link::ResolvedEntity> ResolveQosApart(const link::LinkOptions& options) {
  int ends[2];
  if (pipe(ends) != 0) throw link::LinkError(std::string("pipe: ") + std::strerror(errno));
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw link::LinkError(std::string("fork: ") + std::strerror(errno));
  if (child == 0) {
    DieWith(parent, SIGKILL);
    close(ends[0]);
    TellAndExit(options, ends[1]);
  }
  close(ends[1]);
  const std::string text = ReadAll(ends[0]);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!text.empty() && text.front() == kComplaint) throw link::LinkError(text.substr(1));
  if (!WIFEXITED(status) || text.empty()) {
    throw link::LinkError("QoS file " + options.qos_file +
                          ": the library crashed on it; fleetctl "
                          "qos check says more");
  }
  return Understood(text);
}

}  // namespace giveway::fleetctl
