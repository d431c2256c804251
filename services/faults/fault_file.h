// A fault file as values, as idl/faults.proto says it: what is to go wrong at which time, and what
// at random. Numbers are in their ranges and every target is one its kind allows; whether the
// vehicles exist and what excludes what is for Expand to say. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/faults/fault.h"

namespace giveway::faults {

// One fault at a time that is written down.
struct AtRule {
  std::string name;       // with nth unique in its file
  std::uint32_t nth = 0;  // of that name: lists that Expand made have many of one
  double time_s = 0;      // since the start signal; 0 to 2592000
  double for_s = 0;       // 0: of a kind that takes no time
  Kind kind = Kind::kKill;
  Target target;
  Parameters parameters;
  int line = 0;  // in its file, from 1; 0 if it is from none
};

// The targets of the faults of a random rule.
struct Targets {
  enum class What : std::uint8_t {
    kAnyVehicle,    // each time one of the fleet's
    kEveryVehicle,  // each time all of them, each by itself
    kNamed,         // each time one of `named`
    kWorld,
    kDiscoveryServer,
    kAll,
  };
  What what = What::kAnyVehicle;
  std::vector<VehicleId> named;  // of kNamed: not empty, sorted, each once
};

// Faults at the times of a Poisson process.
struct RandomRule {
  std::string name;  // unique in its file
  Kind kind = Kind::kKill;
  double mean_between_s = 60;  // 0.1 to 2592000
  // How long each takes, uniform; both 0 of a kind that takes no time.
  double for_low_s = 0;
  double for_high_s = 0;
  Targets targets;
  std::optional<std::uint32_t> at_most;  // so many times; absent: until the run ends
  Parameters parameters;
  int line = 0;  // as of AtRule
};

struct FaultFile {
  std::string name;  // of the file, for messages
  std::string description;
  std::vector<AtRule> at;
  std::vector<RandomRule> random;
};

inline constexpr double kLongestRun_s = 30 * 86400.0;
inline constexpr double kLeastMean_s = 0.1;

}  // namespace giveway::faults
