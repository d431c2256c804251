// `fleetctl qos check`, without files and without a command line: bytes in, findings out. Pure, and
// knows no Fast DDS; what it predicts is held against the library in tests/link.
#pragma once

#include <string>
#include <vector>

#include "services/qos/compose.h"
#include "services/qos/deployment.h"
#include "services/qos/finding.h"

namespace giveway::qos {

struct ProfileFile {
  std::string name;   // as findings quote it
  std::string bytes;  // whatever is in it
};

// Of several files each is a process' set: its writers are held against the readers of all.
// Findings come file by file in the order of lines; at most kMostFindings, and one that says so.
inline constexpr std::size_t kMostFindings = 200;
Findings Check(const std::vector<ProfileFile>& files, const Deployment& deployment);

// The same of the fleet that a compose file starts. `set_of` says for each service which of `files`
// it is given; a service that is given none of them is not in it.
struct ComposeSet {
  std::size_t file = 0;  // of `files`
  ComposeService service;
};
Findings Check(const std::vector<ProfileFile>& files, const Deployment& deployment,
               const std::vector<ComposeSet>& set_of);

// Why a process may not start with this set, a line an error: "QoS file FILE:LINE: field: value:
// consequence; remedy". Empty where it may. Processes ask before the library sees the file: it
// hangs on some.
std::string WhyRefused(const ProfileFile& file, const Deployment& deployment);

// 2 with an error, 1 with a warning, 0 clean.
int ExitCode(const Findings& findings);

}  // namespace giveway::qos
