// Draws the plots of a search with gnuplot, if it is installed.
#pragma once

#include <vector>

#include "services/fleetctl/tune/tune_page.h"
#include "services/fleetctl/tune/tune_store.h"

namespace giveway::fleetctl {

// Writes NAME.gnuplot and NAME.svg into the folder. Empty if gnuplot is missing, or refuses: then
// stderr says so.
std::vector<DrawnPlot> Draw(const std::vector<TunePlot>& plots, const TuneStore& store);

}  // namespace giveway::fleetctl
