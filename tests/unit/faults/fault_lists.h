// Faults and files for the tests of the module.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "services/faults/expand.h"
#include "services/faults/kind_table.h"
#include "services/faults/schedule_text.h"

namespace giveway::faults {

// For the messages of failed tests.
inline void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.rule << " " << fault.nth << ": " << Line(fault);
}

inline Target Vehicle(std::uint32_t id) { return {Target::What::kVehicle, VehicleId{id}}; }
inline constexpr Target kWorldTarget{Target::What::kWorld};
inline constexpr Target kAllTarget{Target::What::kAll};

inline std::vector<VehicleId> Fleet(std::uint32_t vehicles) {
  std::vector<VehicleId> ids;
  for (std::uint32_t id = 1; id <= vehicles; ++id) ids.push_back(VehicleId{id});
  return ids;
}

inline Fault Of(Kind kind, Target target, double at_s, double for_s, Parameters parameters = {}) {
  return {"r", 0, at_s, for_s, kind, target, Filled(kind, std::move(parameters))};
}

inline AtRule At(std::string name, Kind kind, Target target, double time_s, double for_s) {
  return {std::move(name), 0, time_s, for_s, kind, target, {}};
}

inline RandomRule Randomly(std::string name, Kind kind, double mean_between_s, double for_low_s,
                           double for_high_s, Targets targets = {}) {
  return {std::move(name), kind, mean_between_s, for_low_s, for_high_s, std::move(targets)};
}

// Nothing is too early or too late.
inline constexpr Course kHour{.seed = 1, .duration_s = 3600, .warm_up_s = 0, .healing_s = 0};

}  // namespace giveway::faults
