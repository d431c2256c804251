#include "services/fleetctl/survey/launch_options.h"

#include <algorithm>
#include <exception>

#include "services/config/flag_values.h"
#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/fleetctl/process/whole_number.h"

namespace giveway::fleetctl {
namespace {

std::string ProgramOf(const std::vector<std::string>& words) {
  return words.empty() ? "" : std::filesystem::path(words.front()).filename().string();
}

std::uint32_t UintOr(std::uint32_t otherwise, const std::optional<std::string>& text) {
  return text ? WholeNumber<std::uint32_t>(*text).value_or(otherwise) : otherwise;
}

// The vehicle's own options; a vehicle that is not named has a place chosen by the world, so any
// fitted sensor counts.
void AddSensors(const Scenario& scenario, LaunchOptions* launch) {
  const bool named = std::ranges::find(scenario.vehicles, launch->id, &VehicleOptions::id) !=
                     scenario.vehicles.end();
  for (const auto* list : {&scenario.vehicles, &scenario.spawns}) {
    for (const VehicleOptions& options : *list) {
      const bool own = list == &scenario.vehicles ? options.id == launch->id : !named;
      if (!own) continue;
      launch->radar |= options.profile.radar;
      launch->lidar |= options.profile.lidar;
      launch->camera |= options.profile.camera;
      launch->pose_fix |= options.profile.pose_fix.Fitted();
    }
  }
}

}  // namespace

std::optional<std::string> Started::Value(const std::string& flag) const {
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == flag && i + 1 < words.size()) return words[i + 1];
    if (words[i].starts_with(flag + "=")) return words[i].substr(flag.size() + 1);
  }
  const std::string twin = TwinOf(flag) + "=";
  for (const std::string& variable : environment) {
    if (variable.starts_with(twin) && variable.size() > twin.size()) {
      return variable.substr(twin.size());
    }
  }
  return std::nullopt;
}

bool Started::Switch(const std::string& flag) const {
  const auto is_on = [](std::string_view value) { return value == "1" || value == "true"; };
  for (auto word = words.rbegin(); word != words.rend(); ++word) {  // the last one counts
    if (*word == flag) return true;
    if (word->starts_with(flag + "=")) return is_on(word->substr(flag.size() + 1));
  }
  const std::string twin = TwinOf(flag) + "=";
  return std::ranges::any_of(environment, [&](const std::string& variable) {
    return variable.starts_with(twin) && is_on(variable.substr(twin.size()));
  });
}

bool Started::IsVehicle() const { return ProgramOf(words) == "giveway-vehicle"; }
bool Started::IsWorld() const { return ProgramOf(words) == "giveway-world"; }
bool Started::IsTool() const {
  return ProgramOf(words) == "fleetctl" || ProgramOf(words) == "giveway-observer";
}

LaunchOptions ReadLaunchOptions(const Started& started, std::vector<std::string>* not_known) {
  LaunchOptions launch;
  launch.is_world = started.IsWorld();
  launch.id = launch.is_world ? kNoVehicle : VehicleId{UintOr(0, started.Value("--id"))};
  launch.domain = UintOr(0, started.Value("--domain"));
  launch.interface = started.Value("--interface").value_or(launch.interface);
  launch.qos_file = started.Value("--qos").value_or("");
  if (const auto text = started.Value("--discovery-server")) {
    ParsedDiscoveryServers parsed = ParseDiscoveryServers(*text);
    if (!parsed.fault.empty()) not_known->push_back("discovery servers: " + *text);
    launch.discovery_servers = std::move(parsed.servers);
  }
  launch.leaves_out_shared_memory = started.Value("--leave-out") == "shared_memory";
  launch.scenario = started.Value("--scenario").value_or("");
  launch.partition_free = !launch.is_world && started.Switch("--partition-free");
  const auto impair = launch.is_world ? std::nullopt : started.Value("--impair");
  if (!impair) return launch;
  ParsedImpairment parsed = ParseImpairment(*impair);
  if (!parsed.problems.empty()) not_known->push_back("impairment: " + *impair);
  launch.impairment = std::move(parsed.impairment);
  return launch;
}

void AddScenario(const std::filesystem::path& file, bool impairment_given, LaunchOptions* launch,
                 std::vector<std::string>* not_known) {
  try {
    const Scenario scenario = LoadScenario(file.string(), {});
    launch->area = scenario.area;
    launch->fleet_size =
        static_cast<std::uint32_t>(scenario.vehicles.size() + scenario.spawns.size());
    launch->signals = !scenario.signals.empty();
    AddSensors(scenario, launch);
    if (!impairment_given && !launch->is_world) launch->impairment = scenario.impairment;
    if (!launch->impairment.seed) launch->impairment.seed = scenario.seed;
  } catch (const std::exception& error) {  // InputError
    not_known->push_back("scenario " + launch->scenario + ": " + error.what());
  }
}

}  // namespace giveway::fleetctl
