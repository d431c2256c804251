// The profile set in the library: loaded once a process, and nothing else of the library's
// configuration is heard.
#pragma once

#include <string>

#include "services/types/admin.h"

namespace giveway::link {

// Loads a complete profile set. Called before any other use of the library, because its first use
// reads environment variables and a file in the current folder. A process has one set: one of the
// same name is taken for it, and nothing is done. Throws LinkError.
void LoadProfiles(const QosProfiles& profiles);

// The error for a profile the loaded set lacks.
[[noreturn]] void ThrowMissingProfile(const std::string& profile);

}  // namespace giveway::link
