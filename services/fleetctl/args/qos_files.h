// Profile files by path or by name, read as bytes.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "services/qos/check.h"
#include "services/types/admin.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// A path, or the shipped set of that name: "lossy_radio". Empty: the shipped default. What is
// neither comes back as it is, for the code that opens it to refuse.
std::string ResolveQosFile(const std::string& argument);

// The file, or the finding that says why it cannot be read. A file over the limit is not read
// whole.
std::variant<qos::ProfileFile, qos::Finding> ReadQosFile(const std::string& path);

// The fleet of a verb that was started elsewhere: how large it is and how fast it ticks is not
// known, and no rule about that speaks.
inline qos::Deployment UnknownFleet() { return {.vehicles = 1, .tick_ns = 0}; }
// The set in the file. Throws LinkError with that finding where it cannot be read.
QosProfiles ReadQosOrThrow(const std::string& path);
// And if the rules of `qos check` find an error in it, before the library hangs on it.
QosProfiles ReadSoundQos(const std::string& path, const qos::Deployment& fleet = UnknownFleet());

qos::Deployment DeploymentOf(const Scenario& scenario);

// What the library finds by itself: NAME=value of this shell, and the names of files in a folder.
std::vector<std::string> OwnEnvironment();
std::vector<std::string> NamesIn(const std::filesystem::path& folder);

}  // namespace giveway::fleetctl
