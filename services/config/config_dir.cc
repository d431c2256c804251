#include "services/config/config_dir.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "services/config/problem.h"
#include "services/types/nearest_name.h"

namespace giveway {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".textproto";

// Both are relative to the running binary, so that a moved tree or an installed one still works.
std::vector<fs::path> Candidates() {
  std::error_code error;
  const fs::path bin = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return {};
  return {bin / "../share/giveway", bin / "../../../config"};  // installed; build/<preset>/bin
}

bool HoldsConfig(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "scenarios", error);
}

// The file itself if it is one, else the one of that name in `folder`, which holds those of `what`.
std::string Resolve(const std::string& argument, const char* folder, const char* what) {
  if (NamesFile(argument)) return argument;
  const fs::path shipped = fs::path(ConfigDir()) / folder;
  const fs::path named = shipped / (argument + kEnding);
  if (!argument.empty() && NamesFile(named)) return named;
  const auto names = ShippedNames(folder);
  std::error_code error;
  const bool is_folder = fs::is_directory(argument, error);
  throw InputError(
      {{argument.empty() ? "\"\"" : argument, 0, "", "",
        fmt::format("{}, and no shipped {} {}{}", is_folder ? "is a folder" : "no such file", what,
                    named.string(), DidYouMean(argument, names)),
        fmt::format("name a file or one of: {}", fmt::join(names, ", "))}});
}

}  // namespace

bool NamesFile(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_directory(status);
}

std::string ConfigDir() {
  const char* given = std::getenv("GIVEWAY_CONFIG_DIR");
  if (given != nullptr && *given != '\0') {
    if (HoldsConfig(given)) return given;
    throw InputError({{given, 0, "GIVEWAY_CONFIG_DIR", given, "holds no folder scenarios/",
                       "name the folder with qos/ and scenarios/, or unset it"}});
  }
  std::vector<std::string> tried;
  for (const fs::path& candidate : Candidates()) {
    tried.push_back(candidate.lexically_normal());
    if (HoldsConfig(candidate)) return tried.back();
  }
  throw InputError({{"config", 0, "", "", fmt::format("not found in {}", fmt::join(tried, ", ")),
                     "set GIVEWAY_CONFIG_DIR to the folder with qos/ and scenarios/"}});
}

std::vector<std::string> ShippedNames(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  try {
    const fs::path shipped = fs::path(ConfigDir()) / folder;
    for (fs::directory_iterator at(shipped, error), end; !error && at != end; at.increment(error)) {
      if (at->path().extension() != ".md") names.push_back(at->path().stem());
    }
  } catch (const InputError&) {  // nothing is shipped
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string ResolveScenario(const std::string& argument) {
  return Resolve(argument, "scenarios", "scenario");
}

std::string ResolveQosFile(const std::string& argument) {
  if (NamesFile(argument)) return argument;
  if (argument.find('/') != std::string::npos || argument.ends_with(".xml")) return argument;
  const fs::path shipped =
      fs::path(ConfigDir()) / "qos" / ((argument.empty() ? "default" : argument) + ".xml");
  return NamesFile(shipped) ? shipped.string() : argument;
}

std::string ResolveFaults(const std::string& argument) {
  return Resolve(argument, "faults", "fault file");
}

std::string ResolveCampaign(const std::string& argument) {
  return Resolve(argument, "campaigns", "campaign");
}

}  // namespace giveway
