// A small file that holds the newest state of a process, for the next one. Whoever reads it finds
// one state or the other, never a mixture: it is written beside and then put in its place. That
// survives the death of the process at any moment; it does not wait for the disk.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace giveway::app {

// The whole file; empty if there is none. Throws std::runtime_error for one that cannot be read.
std::optional<std::string> ReadStateFile(const std::string& path);

// Empty if it is written, else why it could not be.
std::string WriteStateFile(const std::string& path, std::string_view bytes);

void RemoveStateFile(const std::string& path);

}  // namespace giveway::app
