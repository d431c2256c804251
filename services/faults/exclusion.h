// Which two faults cannot be at once on one target: the same kind twice; two that both stop, start
// or set up one process; two cuts of one hearer; anything at or after a kill. Pure.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "services/faults/fault.h"

namespace giveway::faults {

// Do they overlap in time, on one target, by kinds that exclude each other? Ends count as within.
bool Exclude(const Fault& a, const Fault& b);

// Calls `pair` once with the indices of every two that exclude each other. `faults` is sorted by
// at_s. Takes time by how many are at once, not by how many there are.
void ForEachExcluding(std::span<const Fault> faults,
                      const std::function<void(std::size_t, std::size_t)>& pair);

}  // namespace giveway::faults
