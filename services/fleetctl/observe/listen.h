// The verb `fleetctl listen`: prints what travels on one topic. Values in; the exit code out.
#pragma once

#include <cstdint>
#include <optional>

#include "services/fleetctl/args/reading_along.h"
#include "services/fleetctl/observe/listen_topics.h"

namespace giveway::fleetctl {

struct ListenOptions {
  ObserverOptions where;
  ListenFilter filter;
  std::optional<std::uint64_t> count;  // end after so many samples; absent: never
  std::optional<double> duration_s;    // end after so long; absent: never
};

// 0 heard something, or was ended by Ctrl-C or by the reader of stdout; 1 nothing within the
// duration; 2 could not run.
int RunListen(const ListenOptions& options);

}  // namespace giveway::fleetctl
