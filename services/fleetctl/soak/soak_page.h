// A soak's result as one self-contained HTML page. The page is pure text; its pictures are drawn by
// gnuplot (soak_draw.h), and where there is none tables alone say it.
#pragma once

#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// A picture's name, unique in the page, and the gnuplot program that draws it, data included.
struct SoakPlot {
  std::string name;
  std::string title;
  std::string program;
};
// In the order of the page; those that would be empty are left out.
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
