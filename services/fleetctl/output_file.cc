#include "services/fleetctl/output_file.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "services/fleetctl/file_descriptor.h"

namespace giveway::fleetctl {
namespace {

OutputError Refused(const std::string& path, const std::string& why) {
  return OutputError("cannot write " + path + ": " + why +
                     "; name a file in a folder that exists and is yours to write");
}

}  // namespace

void CheckWritable(const std::string& path) {
  std::error_code ignored;
  const bool existed = std::filesystem::exists(path, ignored);
  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
  if (!file.IsOpen()) throw Refused(path, std::strerror(errno));
  if (!existed) std::filesystem::remove(path, ignored);
}

void CheckFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Refused(folder, error.message());
  CheckWritable((std::filesystem::path(folder) / "world.log").string());
}

void WriteFile(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::trunc | std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Refused(path, std::strerror(errno));
}

}  // namespace giveway::fleetctl
