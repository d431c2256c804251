// Which build of a program it is: its GNU build id in hex digits, the linker's hash of its content,
// which does not change when it is stripped or copied.
#pragma once

#include <filesystem>
#include <string>

namespace giveway::fleetctl {

// Of the running program. Empty if it was linked without one.
std::string ProgramId();
// Of an executable file. Empty also if it cannot be read, or is none of this machine's.
std::string ProgramIdOf(const std::filesystem::path& file);

}  // namespace giveway::fleetctl
