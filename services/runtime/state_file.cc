#include "services/runtime/state_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace giveway {

std::optional<std::string> ReadStateFile(const std::string& path) {
  if (access(path.c_str(), F_OK) != 0 && errno == ENOENT) return std::nullopt;
  std::optional<std::string> bytes = ReadWholeFile(path);
  if (!bytes) throw std::runtime_error(FileComplaint(path, "cannot be read"));
  return bytes;
}

void RemoveStateFile(const std::string& path) { std::remove(path.c_str()); }

}  // namespace giveway
