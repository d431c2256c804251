// Variables and files that Fast DDS 2.9 or 3.1 reads by itself, and such that only look as if it
// did. A fleet may run both: what is said holds for either.
#include <algorithm>
#include <array>

#include "services/qos/qos_rules.h"

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

constexpr std::array<std::string_view, 29> kOurs = {
    "GIVEWAY_DOMAIN",           "GIVEWAY_INTERFACE",  "GIVEWAY_QOS",
    "GIVEWAY_SCENARIO",         "GIVEWAY_ID",         "GIVEWAY_SEED",
    "GIVEWAY_BEHAVIOUR",        "GIVEWAY_DURATION",   "GIVEWAY_THREADS",
    "GIVEWAY_VEHICLES",         "GIVEWAY_CHECKPOINT", "GIVEWAY_FAULTS",
    "GIVEWAY_RECORD",           "GIVEWAY_LOCKSTEP",   "GIVEWAY_LOG_LEVEL",
    "GIVEWAY_LOG_FORMAT",       "GIVEWAY_CONFIG_DIR", "GIVEWAY_IMPAIR",
    "GIVEWAY_PARTITION_FREE",   "GIVEWAY_RESUME",     "GIVEWAY_HANG_ON_SIGNAL",
    "GIVEWAY_NO_WATCHDOG",      "GIVEWAY_STAY",       "GIVEWAY_RECORD_SPLIT",
    "GIVEWAY_DISCOVERY_SERVER", "GIVEWAY_HEALTH",     "GIVEWAY_HEALTH_PORT",
    "GIVEWAY_HEALTH_ADDRESS",   "GIVEWAY_RECORD_RING"};

// Letters to change, add or leave out to make one of the other.
std::size_t Distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
    }
  }
  return row[b.size()];
}

void Add(std::string_view rule, const Place& place, std::string_view what, std::string values,
         std::string_view consequence, std::string_view remedy, Findings* findings) {
  findings->push_back({Severity::kWarning, std::string(rule), place, std::string(what),
                       std::move(values), std::string(consequence), std::string(remedy)});
}

}  // namespace

void CheckVariable(std::string_view name, const Place& place, const std::string& is_set,
                   Findings* findings) {
  for (const Variable& known : kVariables) {
    if (known.name == name) {
      Add(known.rule, place, name, is_set, known.consequence, known.remedy, findings);
    }
  }
  if (!name.starts_with("GIVEWAY_") || std::ranges::find(kOurs, name) != kOurs.end()) return;
  const auto near =
      std::ranges::find_if(kOurs, [&](std::string_view ours) { return Distance(name, ours) <= 2; });
  if (near == kOurs.end()) return;
  Add("misnamed_variable", place, name, is_set + "; " + std::string(*near) + " is meant?",
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
