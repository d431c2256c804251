// Makes a failing virtual run small: removes vehicles, faults, walls and radio faults, and shortens
// the time, as long as the same invariant breaks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "services/fleetctl/virtual/virtual_case.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::fleetctl {

struct Shrunk {
  VirtualCase made;
  sim::Violation violation;  // the first of its invariant in the remaining run
  std::uint32_t attempts = 0;
};

// Called before every attempt. False: stop, and take the result so far.
using ShrinkProgress = std::function<bool(const VirtualCase& smallest, std::uint32_t attempts)>;

// nullopt if no invariant breaks in the run.
std::optional<Shrunk> Shrink(const VirtualCase& failing, const ShrinkProgress& progress);

}  // namespace giveway::fleetctl
