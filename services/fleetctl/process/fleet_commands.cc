#include "services/fleetctl/process/fleet_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace giveway::fleetctl {
namespace {

using Words = std::vector<std::string>;

void Append(Words* words, const Words& more) {
  words->insert(words->end(), more.begin(), more.end());
}

Words SharedFlags(const FleetSpec& spec) {
  const FleetOptions& options = spec.options;
  Words flags{"--scenario",  spec.scenario_file, "--domain", std::to_string(spec.domain),
              "--interface", options.interface,  "--qos",    spec.qos_file,
              "--log-level", options.log_level};
  if (!options.discovery_servers.empty()) {
    Append(&flags, {"--discovery-server", ToText(options.discovery_servers)});
  }
  if (options.seed) Append(&flags, {"--seed", std::to_string(*options.seed)});
  if (options.behaviour) Append(&flags, {"--behaviour", std::string(Name(*options.behaviour))});
  if (options.duration_s) Append(&flags, {"--duration", fmt::format("{}", *options.duration_s)});
  if (options.lockstep) flags.emplace_back("--lockstep");
  if (!options.admin_key.empty()) Append(&flags, {"--admin-key", options.admin_key});
  return flags;
}

// The name of its log and its recording, without the ending.
std::string FileNameOf(MemberId member) {
  if (member == kTheWorld) return "world";
  std::string name = NameOf(member);
  std::ranges::replace(name, ' ', '-');
  return name;
}

Words OwnFlags(const FleetOptions& options, MemberId member) {
  Words flags;
  if (member == kTheWorld) return flags;
  if (!options.impair.empty()) Append(&flags, {"--impair", options.impair});
  if (!options.record_folder.empty()) {
    const auto folder = std::filesystem::path(options.record_folder);
    Append(&flags, {"--record", (folder / (FileNameOf(member) + ".recording")).string()});
    if (!options.record_ring.empty()) Append(&flags, {"--record-ring", options.record_ring});
    if (!options.record_split.empty()) Append(&flags, {"--record-split", options.record_split});
  }
  if (member.kind == MemberKind::kVehicle) Append(&flags, {"--id", std::to_string(member.number)});
  return flags;
}

}  // namespace

std::string NameOf(MemberId member) {
  switch (member.kind) {
    case MemberKind::kWorld:
      return "the world";
    case MemberKind::kVehicle:
      return fmt::format("vehicle {}", member.number);
    case MemberKind::kNewcomer:
      return fmt::format("newcomer {}", member.number);
    case MemberKind::kDiscoveryServer:
      return fmt::format("discovery server {}", member.number);
  }
  return {};
}

std::uint32_t NewcomerCount(const FleetOptions& options, const Scenario& scenario) {
  if (scenario.spawns.empty()) return 0;
  if (options.vehicles) return *options.vehicles;
  const auto named = static_cast<std::uint32_t>(scenario.vehicles.size());
  if (scenario.start_with == 0) return static_cast<std::uint32_t>(scenario.spawns.size());
  return scenario.start_with - std::min(named, scenario.start_with);
}

std::vector<MemberCommand> MakeCommands(const FleetSpec& spec, const Scenario& scenario) {
  const Words shared = SharedFlags(spec);
  const std::filesystem::path logs = spec.options.logs_folder;
  std::vector<MemberCommand> commands;
  const auto add = [&](MemberId member) {
    const char* program = member == kTheWorld ? "giveway-world" : "giveway-vehicle";
    ChildCommand child{NameOf(member), {(spec.program_folder / program).string()}};
    Append(&child.words, shared);
    Append(&child.words, OwnFlags(spec.options, member));
    const auto extra = spec.extra_words.find(member);
    if (extra != spec.extra_words.end()) Append(&child.words, extra->second);
    if (!logs.empty()) child.log_file = (logs / (FileNameOf(member) + ".log")).string();
    child.kept_fd = spec.lock_fd;
    child.hands_on_lines = spec.hands_on_lines;
    child.flags_only = spec.flags_only;
    child.handles_stops = true;
    const auto place = static_cast<std::int64_t>(commands.size());
    commands.push_back({member, std::move(child), place * spec.stagger});
  };
  add(kTheWorld);
  for (const VehicleOptions& vehicle : scenario.vehicles) add(MemberOf(vehicle.id));
  for (std::uint32_t i = 1; i <= NewcomerCount(spec.options, scenario); ++i) {
    add({spec.names_newcomers ? MemberKind::kVehicle : MemberKind::kNewcomer, i});
  }
  return commands;
}

}  // namespace giveway::fleetctl
