#include "services/link/fastdds/profile_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "services/link/fastdds/link_options.h"

namespace giveway::link {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 8U << 20U;

void CheckReadable(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    throw LinkError("QoS file " + file +
                    ": does not exist; give a complete profile set such as config/qos/default.xml");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw LinkError("QoS file " + file + ": is not a file; give a profile set, not a folder");
  }
  if (std::filesystem::file_size(file, error) > kMaxFileBytes || error) {
    throw LinkError("QoS file " + file + ": over 8 MiB or not readable");
  }
}

}  // namespace

QosProfiles ReadProfileFile(const std::string& file) {
  CheckReadable(file);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw LinkError("QoS file " + file + ": " + std::strerror(errno) + "; check its permissions");
  }
  std::string text(kMaxFileBytes, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw LinkError("QoS file " + file + ": cannot be read to its end");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  text.shrink_to_fit();
  return {file, std::move(text)};
}

}  // namespace giveway::link
