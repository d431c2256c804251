// Draws a run as SVG: the place, every path, where each vehicle halted, the closest approach. What
// moves by itself stands where it began. Pure text; knows no file.
#pragma once

#include <string>
#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"

namespace giveway::app {

// What an observer saw of one vehicle, in order of ticks; gaps are possible.
struct Track {
  VehicleId vehicle = kNobody;
  std::vector<Truth> truths;
};

// Self-contained SVG, y up as in the world, with a scale bar and a legend.
std::string DrawRun(const Scenario& scenario, const std::vector<Track>& tracks,
                    const std::vector<WorldEvent>& events);

}  // namespace giveway::app
