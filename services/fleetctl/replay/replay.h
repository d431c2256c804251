// The verb `fleetctl replay`: replays recordings of vehicles through a new brain. Values in; the
// exit code out.
#pragma once

#include <string>
#include <vector>

namespace giveway::fleetctl {

struct ReplayOptions {
  std::vector<std::string> files;  // parts of a recording in any order
  std::string trace_file;          // of a single recording; empty: none
  bool json = false;
};

// 0 every step gave the same result, 1 one did not, 2 a file could not be replayed to its end.
int RunReplay(const ReplayOptions& options);

}  // namespace giveway::fleetctl
