// The verb `fleetctl export`: one topic of a recording as lines of JSON or CSV. Values in; the exit
// code out.
#pragma once

#include <string>

namespace giveway::fleetctl {

struct ExportOptions {
  std::string file;
  std::string topic;
  bool csv = false;
  bool json = false;  // the default
};

// 0 exported, 1 the file has nothing of the topic or cannot be read to its end, 2 could not run.
int RunExport(const ExportOptions& options);

}  // namespace giveway::fleetctl
