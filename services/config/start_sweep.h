// Which of many bodies and lines may overlap: a sorted sweep over their bounds, so that a fleet of
// thousands is not compared pair by pair. Lines are not compared with each other.
#pragma once

#include <functional>
#include <vector>

#include "services/config/start_shape.h"

namespace giveway {

struct SweepPairs {
  // Bodies a < b whose bounds overlap, by their indices. Empty: only lines matter.
  std::function<void(std::size_t a, std::size_t b)> bodies;
  std::function<void(std::size_t body, std::size_t line)> body_and_line;
};

// Calls back in an order that depends on nothing but the bounds and their order. What is not finite
// takes no part.
void Sweep(const std::vector<Bounds>& bodies, const std::vector<Bounds>& lines,
           const SweepPairs& visit);

}  // namespace giveway
