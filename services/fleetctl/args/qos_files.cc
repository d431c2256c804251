#include "services/fleetctl/args/qos_files.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "services/config/config_dir.h"
#include "services/link/fastdds/link_options.h"
#include "services/qos/xml_tree.h"
#include "services/types/nearest_name.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

qos::Finding Unreadable(const std::string& path, std::string why) {
  return {qos::Severity::kError,
          "unreadable_file",
          {path, 0},
          "",
          std::move(why),
          "A service that is given this file does not start.",
          "check the path and its permissions"};
}

// "; did you mean 'lossy_radio'?" for a name similar to that of a shipped set.
std::string NearestSet(const std::string& argument) {
  if (argument.find('/') != std::string::npos) return "";
  return DidYouMean(fs::path(argument).stem().string(), ShippedNames("qos"));
}

}  // namespace

std::variant<qos::ProfileFile, qos::Finding> ReadQosFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return Unreadable(path, "does not exist" + NearestSet(path));
  if (!fs::is_regular_file(status)) return Unreadable(path, "is no regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Unreadable(path, std::strerror(errno));
  // One byte more than is allowed shows that it is too large.
  const std::uintmax_t most = qos::kMaxFileBytes + 1;
  qos::ProfileFile file{path, std::string(std::min(fs::file_size(path, error), most), '\0')};
  stream.read(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
  file.bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) return Unreadable(path, "cannot be read to its end");
  return file;
}

qos::Deployment DeploymentOf(const Scenario& scenario) {
  return {.vehicles = static_cast<std::int64_t>(scenario.vehicles.size() + scenario.spawns.size()),
          .signals = static_cast<std::int64_t>(scenario.signals.size()),
          .tick_ns = scenario.tick_period.count()};
}

QosProfiles ReadQosOrThrow(const std::string& path) {
  auto read = ReadQosFile(path);
  if (const auto* const finding = std::get_if<qos::Finding>(&read)) {
    throw link::LinkError("QoS file " + path + ": " + finding->values + "; " + finding->remedy);
  }
  return {path, std::move(std::get<qos::ProfileFile>(read).bytes)};
}

QosProfiles ReadSoundQos(const std::string& path, const qos::Deployment& fleet) {
  QosProfiles profiles = ReadQosOrThrow(path);
  const std::string why = qos::WhyRefused({profiles.name, profiles.text}, fleet);
  if (!why.empty()) throw link::LinkError(why);
  return profiles;
}

std::vector<std::string> OwnEnvironment() {
  std::vector<std::string> variables;
  for (char** at = environ; *at != nullptr; ++at) variables.emplace_back(*at);
  return variables;
}

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    names.push_back(at->path().filename().string());
  }
  return names;
}

}  // namespace giveway::fleetctl
