// A small file that holds the newest state of a process, for the next one. A reader finds one state
// or the other, never a mixture: WriteStateFile in whole_file.h writes it.
#pragma once

#include <optional>
#include <string>

#include "services/runtime/whole_file.h"

namespace giveway {

// The whole file; empty if there is none. Throws std::runtime_error for one that cannot be read.
std::optional<std::string> ReadStateFile(const std::string& path);

void RemoveStateFile(const std::string& path);

}  // namespace giveway
