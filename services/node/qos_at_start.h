// What giveway-vehicle and giveway-world do with their profile set before the library sees it,
// which hangs on some.
#pragma once

#include <string>

#include "services/qos/deployment.h"
#include "services/types/admin.h"
#include "services/types/scenario.h"

namespace giveway {

// What the rules of a set need to know of the fleet of this service, at start and for every order.
qos::Deployment ServiceDeployment(const Scenario& scenario);

// The set in the file, read once for all that need it. Throws LinkError if it cannot be read, or if
// the rules of `fleetctl qos check` find an error in it.
QosProfiles ReadSoundQos(const std::string& file, const Scenario& scenario);

}  // namespace giveway
