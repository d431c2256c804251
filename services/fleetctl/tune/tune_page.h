// A search's result as one self-contained HTML page, and the gnuplot programs of its pictures.
// Pure: who runs gnuplot is tune_run.cc.
#pragma once

#include <string>
#include <vector>

#include "services/fleetctl/tune/tune_result.h"

namespace giveway::fleetctl {

// A picture's name and the program that draws it, data included, to stdout as SVG.
struct TunePlot {
  std::string name;
  std::string title;
  std::string program;
};
std::vector<TunePlot> PlotsOf(const TuneResult& result);

struct DrawnPlot {
  std::string title;
  std::string svg;
};
// `plots` may be empty: the page says that no pictures could be drawn.
std::string ToHtml(const TuneResult& result, const std::vector<DrawnPlot>& plots);

}  // namespace giveway::fleetctl
