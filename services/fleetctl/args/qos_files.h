// Profile files by path or by name, read as bytes.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "services/config/config_dir.h"
#include "services/qos/profile_check.h"
#include "services/types/admin.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// The file, or the finding that says why it cannot be read. A file over the limit is not read
// completely.
std::variant<qos::ProfileFile, qos::Finding> ReadQosFile(const std::string& path);

// A fleet that was started elsewhere: its size and tick are not known, so no rule about them
// applies.
inline qos::Deployment UnknownFleet() { return {.vehicles = 1, .tick_ns = 0}; }
// The set in the file. Throws LinkError with that finding if it cannot be read.
QosProfiles ReadQosOrThrow(const std::string& path);
// Also throws if the rules of `qos check` find an error in it, before the library hangs on it.
QosProfiles ReadSoundQos(const std::string& path, const qos::Deployment& fleet = UnknownFleet());

qos::Deployment DeploymentOf(const Scenario& scenario);

// What the library finds by itself: NAME=value of this shell, and the file names of a folder.
std::vector<std::string> OwnEnvironment();
std::vector<std::string> NamesIn(const std::filesystem::path& folder);

}  // namespace giveway::fleetctl
