// The verb `fleetctl why A B`: can A hear B? Finds both among the processes of this machine,
// predicts, verifies by a probe, prints. Values in; the exit code out.
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
  VehicleId id = kNobody;
  int pid = 0;

  friend bool operator==(const Named&, const Named&) = default;
};

struct WhyOptions {
  Named hearer;
  Named speaker;
  std::optional<std::uint32_t> domain;  // only processes of this one
  std::optional<double> seconds;        // the probe listens at most so long; see ListenSeconds
  bool probe = true;
  bool json = false;
};

// "2", "world", "pid:1234"; nothing if it is none of these.
std::optional<Named> ParseNamed(const std::string& text);
std::string TextOf(const Named& named);

// Which of the members are meant; 0 where there is none. Where several fit, those of one domain
// belong together. Nothing can be chosen: what to say.
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
