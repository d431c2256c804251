// Messages of Fast DDS while a table is drawn on the terminal: a line in the middle would corrupt
// the table, so lines are kept for the next drawing.
#pragma once

#include <string>
#include <vector>

namespace giveway::fleetctl {

// Starts to keep lines if stdout is a terminal. Else they go to stderr as they come.
void KeepLibraryLines();
// The lines since the last call, without the oldest if there were too many.
std::vector<std::string> TakeLibraryLines();

}  // namespace giveway::fleetctl
