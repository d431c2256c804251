// Shows one virtual run: a picture of the paths, and a trace of every vehicle in every tick.
#pragma once

#include <string>

#include "services/fleetctl/virtual/virtual_case.h"
#include "services/report/picture.h"

namespace giveway::fleetctl {

// The files to write for a run; an empty name writes nothing.
struct ShownFiles {
  std::string picture;
  std::string trace;
  std::string mcap;

  bool Any() const { return !picture.empty() || !trace.empty() || !mcap.empty(); }
};

// Runs the case and writes the requested files; the picture has the headline. Throws OutputError,
// once the others are written, for those that could not be.
void ShowRun(const VirtualCase& made, const ShownFiles& files, const Headline& headline);

}  // namespace giveway::fleetctl
