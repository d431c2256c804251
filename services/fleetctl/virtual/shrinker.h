// Makes a failing virtual run small: leaves out vehicles, faults, walls and what goes wrong on the
// radio, and cuts the time, as long as the same invariant breaks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "services/fleetctl/virtual/virtual_case.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::fleetctl {

struct Shrunk {
  VirtualCase made;
  sim::Violation violation;  // the first of its invariant in the run that is left
  std::uint32_t tries = 0;
};

// Called before every try. False: enough, take what there is.
using ShrinkProgress = std::function<bool(const VirtualCase& smallest, std::uint32_t tries)>;

// Nothing if no invariant breaks in the run.
std::optional<Shrunk> Shrink(const VirtualCase& failing, const ShrinkProgress& progress);

}  // namespace giveway::fleetctl
