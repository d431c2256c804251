// Where the shipped profile sets, scenarios, fault files and campaigns are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace giveway {

// Whether something is there that may be read as a file, also a pipe. A folder may have the name of
// what is shipped, and does not hide it.
bool NamesFile(const std::filesystem::path& path);

// The file a scenario argument means: itself if it is one, else the shipped one of that name.
// Throws InputError naming both places and listing the shipped scenarios.
std::string ResolveScenario(const std::string& argument);

// The file a profile set means: itself if it is one, else the shipped one of that name
// ("lossy_radio"), the shipped default if empty. Anything else is returned unchanged, and refused
// by the code that opens it. Throws InputError if there is no ConfigDir().
std::string ResolveQosFile(const std::string& argument);

// As ResolveScenario, of a fault file.
std::string ResolveFaults(const std::string& argument);

// As ResolveScenario, of a campaign.
std::string ResolveCampaign(const std::string& argument);

// The folder holding qos/ and scenarios/: $GIVEWAY_CONFIG_DIR, else next to the installed binary
// (../share/giveway), else the source tree the binary was built in. Throws InputError.
std::string ConfigDir();

// The names of what is shipped in a folder of ConfigDir(), without their endings, sorted; none
// where nothing is shipped.
std::vector<std::string> ShippedNames(const std::string& folder);

}  // namespace giveway
