// Profile files by path or by name, read as bytes.
#pragma once

#include <string>
#include <variant>

#include "services/qos/check.h"

namespace giveway::fleetctl {

// A path, or the shipped set of that name: "lossy_radio". Empty: the shipped default. What is
// neither comes back as it is, for whoever opens it to refuse.
std::string ResolveQosFile(const std::string& argument);

// The file, or the finding that says why it cannot be read. A file over the limit is not read
// whole.
std::variant<qos::ProfileFile, qos::Finding> ReadQosFile(const std::string& path);

}  // namespace giveway::fleetctl
