// What a scenario says of how a vehicle knows where it is: the sensor of fixes, wheels that are not
// what the drive says, and the limit beyond which it is lost.
#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "services/config/section.h"
#include "services/types/robot_model.h"

namespace giveway {

// Of a profile section. What it does not write stays as it was.
void ReadPoseKeeping(const Section& section, RobotModel* profile);

// The limits of all vehicles of a scenario, settled once their profiles are read: the scenario's,
// changed by the vehicle's own. Where neither writes one, a sensor or wheel errors in either bring
// the usual one.
class PoseLimits {
 public:
  // Of the scenario's profile section.
  explicit PoseLimits(std::optional<Section> shared) : shared_(std::move(shared)) {}

  // Of a vehicle with such a section of its own. Fixes too rough for the limit are a problem of
  // what the vehicle writes of the two; of the scenario's profile, once, where it writes neither.
  void Settle(const std::optional<Section>& own, RobotModel* profile);

 private:
  bool Writes(std::string_view field, const std::optional<Section>& own) const;

  std::optional<Section> shared_;
  bool shared_is_blamed_ = false;
};

}  // namespace giveway
