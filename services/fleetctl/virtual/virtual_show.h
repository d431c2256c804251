// Shows one virtual run: a picture of the paths, and a trace of every vehicle in every tick.
#pragma once

#include <string>

#include "services/fleetctl/virtual/virtual_case.h"

namespace giveway::fleetctl {

// The files to write for a run; an empty name writes nothing.
struct ShownFiles {
  std::string picture;
  std::string trace;
  std::string mcap;

  bool Any() const { return !picture.empty() || !trace.empty() || !mcap.empty(); }
};

// Runs the case and writes the requested files. Throws OutputError.
void ShowRun(const VirtualCase& made, const ShownFiles& files);

}  // namespace giveway::fleetctl
