// Draws a run as SVG: the place, every path, where each vehicle halted, the closest approach. What
// moves by itself stands where it started. Pure text; knows no file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/report/report.h"
#include "services/report/track.h"
#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"

namespace giveway {

// What the picture says of the run: the verdict that was printed. The world's own, among its
// events, is not drawn, since it knows nothing of what is found after the run, such as a process
// that died.
struct Headline {
  Verdict verdict = Verdict::kNotRun;
  std::string reason;
};

// Self-contained SVG, y up as in the world, with a scale bar and a legend. Without a headline it
// says that there is no verdict.
std::string DrawRun(const Scenario& scenario, const std::vector<Track>& tracks,
                    const std::vector<WorldEvent>& events,
                    const std::optional<Headline>& headline = std::nullopt);

}  // namespace giveway
