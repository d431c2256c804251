// What giveway-vehicle and giveway-world do with their profile set before the library sees it,
// which hangs on some.
#pragma once

#include <string>

#include "services/types/scenario.h"

namespace giveway {

// Throws LinkError if the rules of `fleetctl qos check` find an error in the set. A file that
// cannot be read is left to the link, which says so.
void RequireSoundQos(const std::string& file, const Scenario& scenario);

}  // namespace giveway
