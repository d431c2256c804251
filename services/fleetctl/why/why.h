// The verb `fleetctl why A B`: can A hear B? Finds both among the processes of this machine,
// predicts, verifies with a probe, prints. Values in; the exit code out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "services/fleetctl/survey/why_proc.h"

namespace giveway::fleetctl {

// What an argument names: a vehicle, the world, or a process.
struct Named {
  bool world = false;
  VehicleId id = kNoVehicle;
  int pid = 0;

  friend bool operator==(const Named&, const Named&) = default;
};

struct WhyOptions {
  Named hearer;
  Named speaker;
  std::optional<std::uint32_t> domain;  // only processes of this one
  std::optional<double> seconds;        // the longest time the probe listens; see ListenSeconds
  bool probe = true;
  bool json = false;
};

// "2", "world", "pid:1234"; nullopt for anything else.
std::optional<Named> ParseNamed(const std::string& text);
std::string TextOf(const Named& named);

// The chosen members; 0 if there is none. If several fit, those of one domain belong together. If
// there is no choice: the message.
struct ChosenPair {
  int hearer = 0;
  int speaker = 0;
};
std::variant<ChosenPair, std::string> Choose(const std::vector<FleetMember>& members,
                                             const WhyOptions& options);

// 0 hears on every topic; 1 does not, or prediction and probe disagree; 2 could not run, or
// nothing is known.
int RunWhy(const WhyOptions& options);

}  // namespace giveway::fleetctl
