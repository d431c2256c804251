// The launch options of a service: its command line, else its environment, by the rules of
// services/config/flags.h. Pure, except that the scenario is read from a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/survey/why_situation.h"

namespace giveway::fleetctl {

// The command line of a process, with its program, and its environment as NAME=value.
struct Started {
  std::vector<std::string> words;
  std::vector<std::string> environment;

  // The value of a flag, else of its environment variable; nullopt if neither is set.
  std::optional<std::string> Value(const std::string& flag) const;
  bool Switch(const std::string& flag) const;
  // Whether it is a service of a fleet, and which one.
  bool IsVehicle() const;
  bool IsWorld() const;
  // Whether it joins fleets without being a part of one: fleetctl, giveway-observer.
  bool IsTool() const;
};

// Everything except the scenario's options and the default of --qos. `not_known` gets what is
// invalid.
LaunchOptions ReadLaunchOptions(const Started& started, std::vector<std::string>* not_known);
// Adds the scenario's options, read from `file`.
void AddScenario(const std::filesystem::path& file, bool impairment_given, LaunchOptions* launch,
                 std::vector<std::string>* not_known);

}  // namespace giveway::fleetctl
