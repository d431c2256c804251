// A soak's result as one self-contained HTML page. The page is pure text; gnuplot draws its plots
// (soak_draw.h), and without it there are only the tables.
#pragma once

#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// The name of a plot, unique in the page, and its gnuplot program, data included.
struct SoakPlot {
  std::string name;
  std::string title;
  std::string program;
};
// In the order of the page; empty ones are left out.
std::vector<SoakPlot> PlotsOf(const SoakResult& result);

// By name.
struct DrawnSoakPlot {
  std::string name;
  std::string title;
  std::string svg;
};
// `plots` may be empty.
std::string ToHtml(const SoakResult& result, const std::vector<DrawnSoakPlot>& plots);
// The summary for a terminal, at most 78 columns wide.
std::string ToText(const SoakResult& result);

}  // namespace giveway::fleetctl
