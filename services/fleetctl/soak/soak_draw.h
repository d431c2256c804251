// Has gnuplot draw a soak's pictures, and writes the report's files.
#pragma once

#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_page.h"
#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// Those that gnuplot draws: where there is none, or it refuses or takes too long, stderr says so.
// Programs and pictures stand in `folder` meanwhile, and are removed. Call from the main thread
// (ChildProcess).
std::vector<DrawnSoakPlot> Draw(const std::vector<SoakPlot>& plots, const std::string& folder);

// The page alone. Throws OutputError.
void WriteSoakPage(const SoakResult& result, const std::string& file);
// report.json first, then report.html, each whole or not at all. Throws OutputError.
void WriteSoakReport(const SoakResult& result, const std::string& folder);

}  // namespace giveway::fleetctl
