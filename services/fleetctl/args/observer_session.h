// What `fleetctl top` and `fleetctl listen` share: they join a fleet started elsewhere as
// observers, start and stop nothing, and write what they receive to stdout.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/link/fastdds/link_options.h"

namespace giveway::fleetctl {

// Where to listen.
struct ObserverOptions {
  std::uint32_t domain = 0;
  std::string interface = "127.0.0.1";
  std::vector<DiscoveryServer> discovery_servers;  // none: as the QoS file says
  std::string area = "main";
  std::string qos_file;   // empty: the shipped one
  std::string admin_key;  // of verbs that give orders; a file, see process/run_key.h
};

// Throws LinkError if the profile set is invalid.
link::LinkOptions LinkOptionsOf(const ObserverOptions& options);

enum class WriteResult : std::uint8_t {
  kWritten,
  kReaderGone,  // the reader has exited, as `| head -3` does: not an error
  kFailed,      // a full disk: errno says why
};

// Writes to stdout at once.
WriteResult WriteStdout(const std::string& text);
// Whether stdout is open. Check it before any socket is opened: a socket that gets the free
// descriptor would be written to.
bool HasStdout();

// The exit code for it; reports a failure on stderr. 0 if the reader has exited.
int ExitCodeOf(WriteResult result);

}  // namespace giveway::fleetctl
