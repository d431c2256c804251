// The verb `fleetctl listen`: prints the samples of one topic. Values in; the exit code out.
#pragma once

#include <cstdint>
#include <optional>

#include "services/fleetctl/args/observer_session.h"
#include "services/fleetctl/observe/listen_topics.h"

namespace giveway::fleetctl {

struct ListenOptions {
  ObserverOptions where;
  ListenFilter filter;
  std::optional<std::uint64_t> count;  // stop after that many samples; absent: never
  std::optional<double> duration_s;    // stop after that time; absent: never
};

// 0 received something, or was ended by Ctrl-C or by the reader of stdout; 1 nothing within the
// duration; 2 could not run.
int RunListen(const ListenOptions& options);

}  // namespace giveway::fleetctl
