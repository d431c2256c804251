// A scenario: the place, the vehicles in it, what is planned to go wrong and what is expected.
// A value; app loads and checks it, everyone else reads it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/types/time.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// A straight wall without thickness, in the world frame, metres.
struct Wall {
  Vec2 from_world;
  Vec2 to_world;
};

enum class FaultKind : std::uint8_t { kKill };

// A planned fault. Due when every given condition holds.
struct PlannedFault {
  FaultKind kind = FaultKind::kKill;
  VehicleId vehicle = kNobody;
  std::optional<double> at_s;               // seconds since the start signal
  std::optional<double> before_crossing_m;  // the vehicle is this near to `crossing`
};

// What must be true at the end for the verdict "passed". Sets are exact and sorted.
struct Expectation {
  std::uint32_t contacts = 0;
  std::vector<VehicleId> halted;
  std::vector<VehicleId> arrived;
  bool parted = false;  // at the end every pair is farther apart than at its closest
  std::optional<double> min_separation_m;  // at least this, shell to shell
  std::optional<double> time_to_clear_s;   // at most this
};

struct Scenario {
  std::string name;
  std::string description;
  std::string area = "main";
  std::uint32_t seed = 0;
  Nanoseconds tick_period{50'000'000};
  double duration_s = 60;
  double start_timeout_s = 15;       // the world gives up waiting for the roster
  double remove_after_s = 5;         // a silent vehicle's body stays this long
  std::uint32_t watchdog_ticks = 3;  // the world stops a vehicle whose last command is older
  Vec2 crossing_world;
  std::vector<VehicleOptions> vehicles;  // sorted by id; start_world set
  std::vector<Wall> walls;
  std::vector<PlannedFault> faults;
  Expectation expect;
};

}  // namespace giveway
