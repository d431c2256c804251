// The QoS file: loaded once a process, and nothing else of the library's configuration is heard.
#pragma once

#include <string>

namespace giveway::link {

// Loads a complete profile set. Called before the library is touched in any other way, because its
// first use reads environment variables and a file in the current folder. A process has one set:
// loading the same file again does nothing. Throws LinkError.
void LoadProfiles(const std::string& file);

// The error for a profile the loaded set lacks.
[[noreturn]] void ThrowMissingProfile(const std::string& profile);

}  // namespace giveway::link
