#include "services/link/fastdds/profiles.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/link_options.h"
#include "services/link/fastdds/profile_words.h"

namespace giveway::link {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 8U << 20U;

std::mutex loading;
std::string loaded_file;  // guarded by `loading`

// QoS has two ways in, the file and our flags. These would be a third, silently.
void ShutOtherWaysIn() {
  for (const char* name : {"FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE",
                           "ROS_DISCOVERY_SERVER", "FASTDDS_ENVIRONMENT_FILE",
                           "FASTDDS_BUILTIN_TRANSPORTS", "ROS_SUPER_CLIENT", "ROS2_EASY_MODE"}) {
    unsetenv(name);
  }
  // Else DEFAULT_FASTRTPS_PROFILES.xml, or in 3.1 DEFAULT_FASTDDS_PROFILES.xml, of the current
  // folder is loaded. The name of this variable in the manual of 2.9, SKIP_DEFAULT_XML, is not the
  // one the library reads.
  setenv("SKIP_DEFAULT_XML_FILE", "1", 1);
}

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

// The library names the file in what it complains about where it reads the file itself.
bool Load(const std::string& file) {
  auto* factory = dds::DomainParticipantFactory::get_instance();
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::string own = InOwnWords(text);
  if (own == text) return Ok(factory->load_XML_profiles_file(file));
  return Ok(factory->load_XML_profiles_string(own.data(), own.size()));
}

}  // namespace

void LoadProfiles(const std::string& file) {
  const std::scoped_lock lock(loading);
  if (loaded_file == file) return;
  if (!loaded_file.empty()) {
    throw LinkError("QoS file " + file + ": this process already uses " + loaded_file +
                    "; the library keeps one set of profiles a process");
  }
  ShutOtherWaysIn();
  TakeOverLibraryLog();
  CheckReadable(file);
  if (!Load(file)) {
    throw LinkError("QoS file " + file +
                    ": the library refuses it; one unknown or malformed element fails the whole "
                    "file, compare with config/qos/default.xml" +
                    LibraryComplaints());
  }
  loaded_file = file;
}

void ThrowMissingProfile(const std::string& profile) {
  const std::scoped_lock lock(loading);
  throw LinkError("QoS file " + loaded_file + ": has no profile \"" + profile +
                  "\"; a set must be complete, copy the profile from config/qos/default.xml" +
                  LibraryComplaints());
}

}  // namespace giveway::link
