// Which faults of a list cannot be carried out where it is to run, and why. Pure: what the host can
// do is a value that another module found out.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/types/scenario.h"

namespace giveway::faults {

// What cannot be carried out, each with the reason in words: "needs root".
struct Incapable {
  std::map<Kind, std::string> kinds;
  std::map<Target::What, std::string> targets;  // whatever the kind
};

// What is refused, once a kind and reason.
struct Unsupported {
  Kind kind = Kind::kKill;
  std::string reason;
  std::vector<std::string> rules;  // that ask for it; sorted, each once
  std::size_t faults = 0;
};

// By kind and reason. Empty: all of it can be carried out.
std::vector<Unsupported> UnsupportedIn(const Schedule& schedule, const Incapable& incapable);
// The rest, in the same order.
Schedule Without(const Schedule& schedule, const Incapable& incapable);

// What no vehicle of the scenario has a sensor for. Without pose fixes nothing shows a vehicle that
// its encoders are wrong: where it believes to be would be wrong from then on.
Incapable IncapableWithSensorsOf(const Scenario& scenario);

// Why the vehicle that the fault names has not what it needs, where others do. Empty: it has, or
// the fault names none of the scenario's vehicles.
std::string WhyTargetLacks(const Fault& fault, const Scenario& scenario);

// Of the virtual fleet: whatever the table says it cannot, and the world and servers as targets.
Incapable IncapableInVirtualTime();

}  // namespace giveway::faults
