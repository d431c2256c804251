#include "services/fleetctl/args/observer_session.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/process/exit_codes.h"

namespace giveway::fleetctl {
namespace {

// Sets only the depth of the event history: up to this many, announcements keep their rate.
constexpr std::uint32_t kFleetSize = 32;

}  // namespace

link::LinkOptions LinkOptionsOf(const ObserverOptions& options) {
  link::LinkOptions link;
  link.domain = options.domain;
  link.interface = options.interface;
  link.qos = ReadSoundQos(ResolveQosFile(options.qos_file));
  link.area = options.area;
  link.fleet_size = kFleetSize;
  link.discovery_servers = options.discovery_servers;
  return link;
}

WriteResult WriteStdout(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0)
    return WriteResult::kWritten;
  return errno == EPIPE ? WriteResult::kReaderGone : WriteResult::kFailed;
}

bool HasStdout() { return ::fcntl(STDOUT_FILENO, F_GETFD) >= 0; }

int ExitCodeOf(WriteResult result) {
  if (result != WriteResult::kFailed) return 0;
  std::fprintf(stderr, "cannot write to stdout: %s\n", std::strerror(errno));
  return kCouldNotRun;
}

}  // namespace giveway::fleetctl
