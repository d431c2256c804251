// `fleetctl ls`: the fleets of this machine, read from /proc alone.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "services/fleetctl/args/observer_session.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/survey/local_fleets.h"
#include "services/runtime/json.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kLsFooter = R"(
A fleet is the processes of one DDS domain on one interface in one network namespace. Reads /proc
alone: joins nothing, sends nothing. Processes of other users are listed as far as they can be seen.

Examples
  fleetctl ls
  fleetctl ls --json | jq '.[].domain'

Exit code: 0 listed, 1 no fleet runs on this machine, 2 could not run.
)";

// "1-3, 5"; those without an id yet are counted.
std::string Ids(const std::vector<FleetMember>& vehicles) {
  std::string text;
  std::size_t unnamed = 0;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const std::uint32_t first = Number(vehicles[i].id);
    if (vehicles[i].id == kNoVehicle) {
      ++unnamed;
      continue;
    }
    std::uint32_t last = first;
    while (i + 1 < vehicles.size() && Number(vehicles[i + 1].id) == last + 1) {
      last = Number(vehicles[++i].id);
    }
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", first,
                        last == first ? "" : fmt::format("-{}", last));
  }
  if (unnamed > 0) text += fmt::format("{}{} joining", text.empty() ? "" : ", ", unnamed);
  return text.empty() ? "none" : text;
}

std::string Table(const std::vector<LocalFleet>& fleets, std::uint64_t here) {
  std::string text = fmt::format("{:>6}  {:<15}  {:<10}  {:>7}  {}\n", "domain", "interface",
                                 "network", "world", "vehicles");
  for (const LocalFleet& fleet : fleets) {
    const std::string network =
        fleet.network_namespace == here ? "here" : std::to_string(fleet.network_namespace);
    const std::string world =
        fleet.worlds.empty() ? "none" : fmt::format("{}", fmt::join(fleet.worlds, ","));
    // Any user's command line, as it was written.
    text += fmt::format("{:>6}  {:<15}  {:<10}  {:>7}  {}\n", fleet.domain,
                        Printable(fleet.interface), network, world, Ids(fleet.vehicles));
  }
  return text;
}

Json MemberJson(const FleetMember& vehicle) {
  Json json;
  if (vehicle.id != kNoVehicle) json["id"] = Number(vehicle.id);
  json["pid"] = vehicle.pid;
  return json;
}

std::string ToJson(const std::vector<LocalFleet>& fleets) {
  return JsonText(JsonArray(fleets, [](const LocalFleet& fleet) {
    Json object;
    object["domain"] = fleet.domain;
    object["interface"] = fleet.interface;
    object["network_namespace"] = fleet.network_namespace;
    object["world_pids"] = fleet.worlds;
    object["vehicles"] = JsonArray(fleet.vehicles, MemberJson);
    return object;
  }));
}

int RunLs(bool json) {
  const std::vector<LocalFleet> fleets = LocalFleets();
  if (json) {
    const int code = ExitCodeOf(WriteStdout(ToJson(fleets) + "\n"));
    return code != 0 ? code : fleets.empty() ? 1 : 0;
  }
  if (fleets.empty()) {
    std::fprintf(stderr,
                 "no fleet runs on this machine, as far as this user can see its processes (root "
                 "sees all)\n");
    return 1;
  }
  return ExitCodeOf(WriteStdout(Table(fleets, OwnNetworkNamespace().value_or(0))));
}

}  // namespace

void AddLsVerb(CLI::App* fleetctl, int* exit_code) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* verb = fleetctl->add_subcommand("ls", "List the fleets of this machine");
  verb->footer(kLsFooter);
  verb->add_flag("--json", *json, "Print one JSON array on stdout and nothing else");
  verb->callback([json, exit_code] { *exit_code = RunLs(*json); });
}

}  // namespace giveway::fleetctl
