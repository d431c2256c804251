// The order in which the processes of a fleet take another set while they run, so that at every
// moment every writer matches every reader it matched before. Where no order of the old and the new
// set does it, each process first takes a set between the two, in which writers offer the more of
// both and readers request the less. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "services/qos/changes.h"
#include "services/qos/finding.h"
#include "services/qos/profile_set.h"

namespace giveway::qos {

struct RolloutProcess {
  std::string name;  // "vehicle 3", "the world": for findings
  Role role = Role::kVehicle;
  ProfileSet set;     // what it runs with
  bool moves = true;  // false: it keeps that
};

struct RolloutStep {
  std::size_t process = 0;
  bool between = false;  // takes the set between, not yet the wanted one
};

struct Rollout {
  std::vector<RolloutStep> steps;
  std::string between;  // the text of that set; empty if no step takes it
  Findings blocked;     // which values forbid every order; there are no steps then
};

// `first` is the vehicle that takes the wanted set before every other vehicle, if any.
Rollout PlanRollout(const std::vector<RolloutProcess>& processes, const std::string& wanted,
                    const std::string& wanted_name, std::optional<std::size_t> first);

}  // namespace giveway::qos
