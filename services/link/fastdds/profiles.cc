#include "services/link/fastdds/profiles.h"

#include <cstdlib>
#include <mutex>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/link_options.h"
#include "services/link/fastdds/profile_spelling.h"

namespace giveway::link {
namespace {

std::mutex loading;
std::string loaded;  // the name of the set; guarded by `loading`

// QoS has two sources, the file and our flags. These would silently be a third.
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

bool Load(const std::string& text) {
  const std::string own = InOwnSpelling(text);
  auto* factory = dds::DomainParticipantFactory::get_instance();
  return Ok(factory->load_XML_profiles_string(own.data(), own.size()));
}

}  // namespace

void LoadProfiles(const QosProfiles& profiles) {
  const std::scoped_lock lock(loading);
  if (loaded == profiles.name) return;
  if (!loaded.empty()) {
    throw LinkError("QoS file " + profiles.name + ": this process already uses " + loaded +
                    "; the library keeps one set of profiles a process");
  }
  ShutOtherWaysIn();
  TakeOverLibraryLog();
  if (!Load(profiles.text)) {
    throw LinkError("QoS file " + profiles.name +
                    ": the library refuses it; one unknown or malformed element fails the whole "
                    "file, compare with config/qos/default.xml" +
                    LibraryComplaints());
  }
  loaded = profiles.name;
}

void ThrowMissingProfile(const std::string& profile) {
  const std::scoped_lock lock(loading);
  throw LinkError("QoS file " + loaded + ": has no profile \"" + profile +
                  "\"; a set must be complete, copy the profile from config/qos/default.xml" +
                  LibraryComplaints());
}

}  // namespace giveway::link
