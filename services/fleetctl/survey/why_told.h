// The launch options of a service: its command line, else its environment, as
// services/config/flags.h has it. Pure, but for the scenario, which is a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/survey/why_situation.h"

namespace giveway::fleetctl {

// The words of a process, its program first, and its NAME=value.
struct Started {
  std::vector<std::string> words;
  std::vector<std::string> environment;

  // The value of a flag, else of its twin; nothing if neither is set.
  std::optional<std::string> Value(const std::string& flag) const;
  bool Switch(const std::string& flag) const;
  // Whether it is a service of a fleet, and which.
  bool IsVehicle() const;
  bool IsWorld() const;
};

// All but what the scenario and the default of --qos say. `not_known` gets what makes no sense.
Instructions ReadTold(const Started& started, std::vector<std::string>* not_known);
// Adds what the scenario says, read from `file`.
void AddScenario(const std::filesystem::path& file, bool impairment_given, Instructions* told,
                 std::vector<std::string>* not_known);

}  // namespace giveway::fleetctl
