#include "services/fleetctl/tune/tune_draw.h"

#include <cstdio>

#include "services/fleetctl/process/gnuplot.h"
#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {

std::vector<DrawnPlot> Draw(const std::vector<TunePlot>& plots, const TuneStore& store) {
  std::vector<DrawnPlot> drawn;
  for (const TunePlot& plot : plots) {
    const std::string svg = (store.Folder() / (plot.name + ".svg")).string();
    const std::string program = plot.name + ".gnuplot";
    store.Write(program, "set output " + GnuplotQuoted(svg) + "\n" + plot.program);
    const std::string complaint = RunGnuplot((store.Folder() / program).string());
    if (!complaint.empty()) {
      std::fprintf(stderr, "no pictures: %s\n", complaint.c_str());
      return {};
    }
    drawn.push_back({plot.title, ReadWholeFile(svg).value_or("")});
  }
  return drawn;
}

}  // namespace giveway::fleetctl
