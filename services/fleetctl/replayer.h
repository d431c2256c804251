// Leads a fresh brain through a recording and compares, step by step and bit by bit. Pure but for
// the stream it reads.
#pragma once

#include <functional>
#include <istream>

#include "services/app/replay_report.h"
#include "services/vehicle/vehicle.h"

namespace giveway::fleetctl {

// Called after every replayed step, the one that differs included.
using ReplayWatcher = std::function<void(const app::RecordedStep& recorded, const Vehicle& brain,
                                         const Outputs& replayed)>;

// Stops at the first difference: what a brain does after it says nothing more. The file's name is
// left to the caller.
app::ReplayedFile Replay(std::istream* recording, const ReplayWatcher& watch = {});

}  // namespace giveway::fleetctl
