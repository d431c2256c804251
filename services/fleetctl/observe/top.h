// The verb `fleetctl top`: a table of a fleet started elsewhere. Values in; the exit code out.
#pragma once

#include "services/fleetctl/args/observer_session.h"

namespace giveway::fleetctl {

struct TopOptions {
  ObserverOptions where;
  bool once = false;
  double wait_s = 5;  // with `once`: longest wait for a vehicle
  bool json = false;
};

// 0 shown, or ended by Ctrl-C or by the reader of stdout; 1 nothing was received (with `once`); 2
// could not run.
int RunTop(const TopOptions& options);

}  // namespace giveway::fleetctl
