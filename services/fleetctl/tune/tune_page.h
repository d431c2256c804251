// A search's result as one self-contained HTML page, and the gnuplot programs of its plots. Pure:
// tune_run.cc runs gnuplot.
#pragma once

#include <string>
#include <vector>

#include "services/fleetctl/tune/tune_result.h"

namespace giveway::fleetctl {

// The name of a plot and its gnuplot program, data included, which writes SVG to stdout.
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
// `plots` may be empty: the page says that no plots could be drawn.
std::string ToHtml(const TuneResult& result, const std::vector<DrawnPlot>& plots);

}  // namespace giveway::fleetctl
