// Variables and files that Fast DDS 2.9 or 3.1 reads by itself, and such that only look as if it
// did. A fleet may run both: what is said holds for either.
#include <algorithm>
#include <array>

#include "services/qos/qos_rules.h"
#include "services/types/nearest_name.h"

namespace giveway::qos {
namespace {

struct Variable {
  std::string_view name;
  std::string_view rule;
  std::string_view consequence;
  std::string_view remedy;
};

constexpr std::array kVariables = {
    Variable{"SKIP_DEFAULT_XML", "misnamed_variable",
             "Fast DDS does not read it, though the manual of 2.9 names it.",
             "SKIP_DEFAULT_XML_FILE; the services set it themselves"},
    Variable{"FASTDDS_DEFAULT_PROFILES_FILE", "misnamed_variable",
             "Only Fast DDS 3 reads it, and the services shut it out.",
             "--qos FILE or GIVEWAY_QOS"},
    Variable{"FASTDDS_BUILTIN_TRANSPORTS", "misnamed_variable",
             "Only Fast DDS 3 reads it, and the services shut it out.",
             "transports of the profile set"},
    Variable{"ROS_SUPER_CLIENT", "misnamed_variable",
             "Only Fast DDS 3 reads it, and the services shut it out.",
             "discoveryProtocol of the profile set"},
    Variable{"ROS2_EASY_MODE", "misnamed_variable",
             "Neither Fast DDS 2.9 nor 3.1 reads it, and the services shut it out.",
             "discoveryProtocol of the profile set"},
    Variable{"FASTRTPS_DEFAULT_PROFILES_FILE", "ignored_variable",
             "The services shut it out; other programs of Fast DDS 2 of this shell take other QoS.",
             "--qos FILE or GIVEWAY_QOS"},
    Variable{"ROS_DISCOVERY_SERVER", "ignored_variable",
             "The services shut it out; other Fast DDS programs of this shell find others.",
             "discoveryServersList of the profile set"},
    Variable{"FASTDDS_ENVIRONMENT_FILE", "ignored_variable", "The services shut it out.",
             "the profile set"},
    Variable{"FASTDDS_STATISTICS", "statistics_on",
             "Every participant gets further writers and a thread, and discovery costs more.",
             "unset it outside of experiments"},
};

// What the programs read. Tests hold it against the flags of each: one that is missing here is
// taken for a misspelt one, and misspellings of it are not noticed.
constexpr std::array<std::string_view, 49> kOurs = {
    // of giveway-vehicle and giveway-world, some of fleetctl and of giveway-observer, too
    "GIVEWAY_SCENARIO",
    "GIVEWAY_DOMAIN",
    "GIVEWAY_INTERFACE",
    "GIVEWAY_DISCOVERY_SERVER",
    "GIVEWAY_QOS",
    "GIVEWAY_ID",
    "GIVEWAY_RECORD",
    "GIVEWAY_RECORD_SPLIT",
    "GIVEWAY_RECORD_RING",
    "GIVEWAY_IMPAIR",
    "GIVEWAY_IMPAIR_SINCE",
    "GIVEWAY_STAY",
    "GIVEWAY_PARTITION_FREE",
    "GIVEWAY_HANG_ON_SIGNAL",
    "GIVEWAY_NO_WATCHDOG",
    "GIVEWAY_THREADS",
    "GIVEWAY_CHECKPOINT",
    "GIVEWAY_FAULTS",
    "GIVEWAY_LEAVE_OUT",
    "GIVEWAY_TRY_QOS",
    "GIVEWAY_RESUME",
    "GIVEWAY_FORMER_QOS",
    "GIVEWAY_ROLLED_BACK",
    "GIVEWAY_MEMORY_LOST",
    "GIVEWAY_GO_ON_FROM",
    "GIVEWAY_SEED",
    "GIVEWAY_BEHAVIOUR",
    "GIVEWAY_DURATION",
    "GIVEWAY_ADMIN",
    "GIVEWAY_ADMIN_KEY",
    "GIVEWAY_LOCKSTEP",
    "GIVEWAY_HEALTH",
    "GIVEWAY_HEALTH_PORT",
    "GIVEWAY_HEALTH_ADDRESS",
    "GIVEWAY_LOG_FORMAT",
    "GIVEWAY_LOG_LEVEL",
    "GIVEWAY_CONFIG_DIR",
    // of giveway-observer alone
    "GIVEWAY_AREA",
    "GIVEWAY_ADDRESS",
    "GIVEWAY_PORT",
    "GIVEWAY_FOXGLOVE_PORT",
    "GIVEWAY_HOST_NAME",
    "GIVEWAY_ROS2",
    "GIVEWAY_ROS2_RATE",
    "GIVEWAY_ROS2_DOMAIN",
    // of fleetctl alone
    "GIVEWAY_VEHICLES",
    "GIVEWAY_RUN_RESTART",
    "GIVEWAY_RECORD_TOPICS",
    "GIVEWAY_ATTACKER",
};

constexpr std::string_view kPrefix = "GIVEWAY_";

// Ours that was probably meant: at most two letters differ, and a third of them, for a short name
// is near to many a word. Empty: none.
std::string_view Meant(std::string_view name) {
  constexpr std::size_t kMost = 2;
  constexpr std::size_t kOneInSo = 3;
  std::string_view nearest;
  std::size_t least = kMost + 1;
  for (const std::string_view ours : kOurs) {
    if (name.size() > ours.size() + kMost) continue;  // of any length: the rest takes time
    const std::size_t distance = EditDistance(name, ours);
    const std::size_t letters = std::max(name.size(), ours.size()) - kPrefix.size();
    if (distance >= least || distance * kOneInSo > letters) continue;
    nearest = ours;
    least = distance;
  }
  return nearest;
}

void Add(std::string_view rule, const Place& place, std::string_view what, std::string values,
         std::string_view consequence, std::string_view remedy, Findings* findings) {
  findings->push_back({Severity::kWarning, std::string(rule), place, std::string(what),
                       std::move(values), std::string(consequence), std::string(remedy)});
}

}  // namespace

std::span<const std::string_view> OwnVariables() { return kOurs; }

void CheckVariable(std::string_view name, const Place& place, const std::string& is_set,
                   Findings* findings) {
  for (const Variable& known : kVariables) {
    if (known.name == name) {
      Add(known.rule, place, name, is_set, known.consequence, known.remedy, findings);
    }
  }
  if (!name.starts_with(kPrefix) || std::ranges::find(kOurs, name) != kOurs.end()) return;
  const std::string_view meant = Meant(name);
  if (meant.empty()) return;
  Add("misnamed_variable", place, name, is_set + "; " + std::string(meant) + " is meant?",
      "No service reads it.", "correct the name", findings);
}

void CheckSurroundings(const Deployment& deployment, Findings* findings) {
  for (const std::string& variable : deployment.environment) {
    CheckVariable(std::string_view(variable).substr(0, variable.find('=')), {},
                  "is set in the environment", findings);
  }
  for (const std::string& file : deployment.folder_files) {
    const bool of2 = file == "DEFAULT_FASTRTPS_PROFILES.xml";
    if (!of2 && file != "DEFAULT_FASTDDS_PROFILES.xml") continue;
    findings->push_back(
        {Severity::kWarning,
         "default_profiles_file",
         {file, 0},
         "",
         "lies in the working folder",
         std::string("Every program of Fast DDS ") + (of2 ? "2" : "3") +
             " started here loads it silently; the services shut it out, other tools then "
             "differ from them.",
         "rename it, and name it with --qos"});
  }
}

}  // namespace giveway::qos
