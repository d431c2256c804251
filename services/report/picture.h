// Draws a run as SVG: the place, every path, where each vehicle halted, the closest approach. What
// moves by itself stands where it started. Pure text; knows no file.
#pragma once

#include <string>
#include <vector>

#include "services/report/track.h"
#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"

namespace giveway {

// Self-contained SVG, y up as in the world, with a scale bar and a legend.
std::string DrawRun(const Scenario& scenario, const std::vector<Track>& tracks,
                    const std::vector<WorldEvent>& events);

}  // namespace giveway
