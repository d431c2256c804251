// How the modes of a fleet change in a soak, and how soon all vehicles drive again once the faults
// are over. Bounded. Pure.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_seen.h"
#include "services/fleetctl/soak/soak_watch.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// Ids of the vehicles of a soak: the scenario's in a closed fleet, the first ones in an open one.
std::vector<VehicleId> SoakFleet(const Scenario& scenario, std::uint32_t newcomers);

class FleetCourse {
 public:
  using Asked = std::function<bool(VehicleId)>;

  // `is_away`: the process is meant to be gone; `is_gone`: permanently.
  FleetCourse(std::vector<VehicleId> fleet, Asked is_away, Asked is_gone)
      : fleet_(std::move(fleet)), is_away_(std::move(is_away)), is_gone_(std::move(is_gone)) {}

  void NoteModes(const SoakWatch& watch, SteadyTime now, SoakSeen* seen);
  // From the end of the last fault on.
  void SeekHealing(const SoakWatch& watch, SteadyTime now, SoakSeen* seen);

 private:
  std::string ModeOf(const SoakWatch& watch, VehicleId vehicle, SteadyTime now) const;

  std::vector<VehicleId> fleet_;
  Asked is_away_;
  Asked is_gone_;
  std::map<VehicleId, std::string> mode_;
  std::optional<SteadyTime> healed_from_;
};

}  // namespace giveway::fleetctl
