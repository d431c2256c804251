// What a scenario file plans to go wrong and what it expects at the end.
#pragma once

#include <set>

#include "services/config/section.h"
#include "services/types/scenario.h"

namespace giveway {

inline constexpr Allowed kDuration{0, 86400, "s", true};  // of a run

// The ids of a scenario that its plans may name.
struct KnownIds {
  std::set<VehicleId> vehicles;  // of the file
  std::set<VehicleId> joining;   // such as the world gives to the spawn places
  std::set<SignalId> signals;
};
KnownIds IdsOf(const Scenario& scenario);

// `root` is the file's: it says whether there is a crossing.
PlannedFault ReadFault(const Section& section, const Section& root, const KnownIds& known);
Expectation ReadExpectation(const Section& section, const KnownIds& known,
                            const Scenario& scenario);

}  // namespace giveway
