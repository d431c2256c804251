// Makes a failing virtual run small: removes vehicles, faults, bodies, walls, doors, signal heads
// and radio faults, and shortens the time, as long as the same invariant breaks.
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
  // It breaks as its file is read. Else the last digits of angles, which a file rounds, matter.
  bool as_file = false;
};

// Called before every attempt. False: stop, and take the result so far.
using ShrinkProgress = std::function<bool(const VirtualCase& smallest, std::uint32_t attempts)>;

// By the invariant `which`, or that which breaks first. nullopt if it holds.
std::optional<Shrunk> Shrink(const VirtualCase& failing, const ShrinkProgress& progress,
                             std::optional<sim::Invariant> which = std::nullopt);

}  // namespace giveway::fleetctl
