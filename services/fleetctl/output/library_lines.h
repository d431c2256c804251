// What Fast DDS complains of while a table is drawn on the terminal: a line in the middle of it
// would tear it, so lines are kept for the next drawing.
#pragma once

#include <string>
#include <vector>

namespace giveway::fleetctl {

// From now on, where stdout is a terminal. Else they go to stderr as they come.
void KeepLibraryLines();
// Those since the last call, the oldest left out where there were too many.
std::vector<std::string> TakeLibraryLines();

}  // namespace giveway::fleetctl
