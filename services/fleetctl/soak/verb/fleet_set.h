// The profile set of a soak's fleet, as far as it decides which faults can have an effect.
#pragma once

#include <map>
#include <string>

#include "services/faults/fault.h"
#include "services/qos/profile_set.h"

namespace giveway::fleetctl {

class FleetSet {
 public:
  // Throws LinkError if the set in the file is not sound, as WhyNot does of a fault's own.
  explicit FleetSet(const std::string& file);

  // Why a fault has no effect on vehicles with this set, or keeps them from starting. Empty: it has
  // one.
  std::string WhyNot(const faults::Fault& fault);

 private:
  std::string WhyNoMismatch(const std::string& name) const;

  qos::ProfileSet set_;
  std::map<std::string, std::string> no_mismatch_;  // by the fault's set; a list of weeks has few
};

}  // namespace giveway::fleetctl
