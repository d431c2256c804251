#include "services/fleetctl/why/why_rules.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/qos/qos_rules.h"

namespace giveway::fleetctl {
namespace {

constexpr std::uint64_t kSpareFiles = 16;

std::string OwnPartition(VehicleId vehicle) {
  return vehicle == kNoVehicle ? "v*" : fmt::format("v{}", Number(vehicle));
}

Outlook OutlookOf(const Causes& causes, bool facts_known, bool in_place) {
  const auto any = [&](Weight weight) {
    return std::ranges::any_of(causes, [&](const Cause& cause) {
      return cause.weight == weight && (cause.in_place || !in_place);
    });
  };
  if (any(Weight::kPrevents)) return Outlook::kCannot;
  return any(Weight::kMayPrevent) || !facts_known ? Outlook::kNotKnown : Outlook::kHears;
}

// Whether the facts are known on which the outlook rests if no cause speaks against it.
bool FactsKnown(const ProcessSituation& process) {
  return process.launch.domain != 0 && process.network_namespace && process.addresses &&
         process.profiles && process.state;
}

void CheckEnvironment(const ProcessSituation& process, Causes* causes) {
  qos::Findings findings;
  for (const std::string& variable : process.environment) {
    qos::CheckVariable(std::string_view(variable).substr(0, variable.find('=')), {},
                       "is set in the environment of " + NameOf(process), &findings);
  }
  for (qos::Finding& finding : findings) {
    causes->push_back({std::move(finding), Weight::kBeside});
  }
}

void CheckProfilesChanged(const ProcessSituation& process, Causes* causes) {
  if (!process.profiles_changed) return;
  causes->push_back(
      {{qos::Severity::kWarning,
        "profiles_changed",
        {process.launch.qos_file, 0},
        NameOf(process),
        "the file was written to after the process started",
        "The process runs with what it read then, which may differ from what is predicted here.",
        "restart the process, or compare with fleetctl qos show --live"},
       Weight::kBeside});
}

// A stopped process neither sends nor receives: but in its place another would receive.
void CheckState(const ProcessSituation& process, bool hears, Causes* causes) {
  if (!process.state) return;
  const char state = *process.state;
  if (state != 'T' && state != 't') return;
  const std::string deaf = "It takes nothing from its readers until it is resumed.";
  const std::string silent = "It sends nothing until it is resumed.";
  causes->push_back({{qos::Severity::kError,
                      "process_stopped",
                      {},
                      NameOf(process),
                      fmt::format("is in state {} ({}), and not running", state,
                                  state == 'T' ? "stopped by a signal" : "stopped by a debugger"),
                      hears ? deaf : silent,
                      fmt::format("kill -CONT {}, or let the debugger go", process.pid)},
                     Weight::kPrevents,
                     !hears});
}

void CheckParticipant(const ProcessSituation& process, bool hears, Causes* causes) {
  if (!process.ports || process.launch.domain == 0 || !ParticipantIds(process).empty()) return;
  if (process.state == 'Z') return;  // said already
  causes->push_back({{qos::Severity::kError,
                      "no_participant",
                      {},
                      NameOf(process),
                      fmt::format("holds {} UDP ports, and none of domain {}",
                                  process.ports->size(), process.launch.domain),
                      "It has no participant in its domain: it neither hears nor sends.",
                      "its log says why; mutation_tries limits how many participants a host has"},
                     Weight::kPrevents,
                     !hears});
}

void CheckFiles(const ProcessSituation& process, Causes* causes) {
  if (!process.open_files || !process.open_files_limit) return;
  if (*process.open_files + kSpareFiles <= *process.open_files_limit) return;
  causes->push_back(
      {{qos::Severity::kWarning,
        "open_files_limit",
        {},
        NameOf(process),
        fmt::format("has {} files open of at most {}", *process.open_files,
                    *process.open_files_limit),
        "A transport that needs one more socket or memory file does not open, without a sign.",
        "raise ulimit -n of the process"},
       Weight::kBeside});
}

}  // namespace

void CheckProcess(const ProcessSituation& process, bool hears, Causes* causes) {
  CheckParticipant(process, hears, causes);
  CheckState(process, hears, causes);
  CheckFiles(process, causes);
  CheckProfilesChanged(process, causes);
  CheckEnvironment(process, causes);
}

std::vector<TopicOutlook> TopicsBetween(const LaunchOptions& hearer, const LaunchOptions& speaker) {
  std::vector<TopicOutlook> topics;
  const auto add = [&](const char* topic, std::string read_in) {
    topics.push_back({.topic = topic, .read_in = std::move(read_in), .causes = {}});
  };
  if (hearer.is_world && speaker.is_world) return topics;
  if (hearer.is_world) {
    add("fleet/motor_command", "v*");
    add("fleet/join", "fleet");
    return topics;
  }
  if (!speaker.is_world) {
    add("fleet/beacon", hearer.area + "/*");
    return topics;
  }
  const std::string own = OwnPartition(hearer.id);
  add("world/ranges", own);
  if (hearer.radar) add("world/radar", own);
  if (hearer.lidar) add("world/lidar", own);
  if (hearer.camera) add("world/camera", own);
  if (hearer.pose_fix) add("world/pose_fix", own);
  if (hearer.signals) add("world/signal", "world");
  add("world/roster", "world");
  return topics;
}

std::vector<TopicOutlook> Predict(const ProcessSituation& hearer, const ProcessSituation& speaker,
                                  std::uint32_t vehicles) {
  const bool known = FactsKnown(hearer) && FactsKnown(speaker);
  std::vector<TopicOutlook> topics = TopicsBetween(hearer.launch, speaker.launch);
  for (TopicOutlook& topic : topics) {
    Causes causes;
    CheckDomains(hearer, speaker, &causes);
    CheckNetworks(hearer, speaker, &causes);
    CheckSharedMemory(hearer, speaker, &causes);
    CheckDiscovery(hearer, speaker, &causes);
    CheckPartitions(hearer, speaker, topic, &causes);
    CheckPolicies(hearer, speaker, topic, vehicles, &causes);
    CheckProcess(hearer, true, &causes);
    CheckProcess(speaker, false, &causes);
    CheckImpairment(hearer, speaker, &causes);
    std::ranges::stable_sort(causes, {}, &Cause::weight);
    topic.outlook = OutlookOf(causes, known, false);
    topic.in_place = OutlookOf(causes, known, true);
    topic.causes = std::move(causes);
  }
  return topics;
}

}  // namespace giveway::fleetctl
