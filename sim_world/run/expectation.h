// Compares the result of a run with what its scenario expects.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/types/scenario.h"

namespace giveway::sim {

// The result of a run, in the terms of Expectation. Sets are sorted.
struct Outcome {
  std::uint32_t contacts = 0;
  std::vector<VehicleId> halted;
  std::vector<Rule> halted_for;  // what started the halts; sorted, each once
  std::vector<VehicleId> arrived;
  bool parted = false;
  std::optional<double> min_separation_m;  // none if no two bodies shared the world
  std::optional<double> time_to_clear_s;   // none if a live vehicle did not reach its goal
};

// Empty if every expectation is met, else each that is not, joined by "; ", for example
// "halted: expected 2, got 1 2".
std::string Unmet(const Expectation& expect, const Outcome& outcome);

}  // namespace giveway::sim
