// The order in which vehicles that drive straight to their goals reach the points where their paths
// meet. Facts of a scenario; books nothing.
#pragma once

#include <cstddef>
#include <vector>

#include "services/types/scenario.h"

namespace giveway::bench {

struct Arrival {
  double comes_m = 0;  // from the start to where another's path first crosses its own
  double comes_s = 0;  // there, when alone
  // Indices of those in its own lane that stand ahead of it or end further on.
  std::vector<std::size_t> let_first;
};

// In the scenario's order. Bodies block each other nearer than near_m, centre to centre.
std::vector<Arrival> ArrivalsOf(const Scenario& scenario, double near_m);

}  // namespace giveway::bench
