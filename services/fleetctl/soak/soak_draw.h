// Draws a soak's plots with gnuplot, and writes the report's files.
#pragma once

#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_page.h"
#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// Those that gnuplot draws: if it is missing, refuses or takes too long, this is reported on
// stderr. Programs and pictures are in `folder` meanwhile, and are removed. Call from the main
// thread (ChildProcess).
std::vector<DrawnSoakPlot> Draw(const std::vector<SoakPlot>& plots, const std::string& folder);

// The page alone. Throws OutputError.
void WriteSoakPage(const SoakResult& result, const std::string& file);
// report.json first, then report.html, each atomically. Throws OutputError.
void WriteSoakReport(const SoakResult& result, const std::string& folder);

}  // namespace giveway::fleetctl
