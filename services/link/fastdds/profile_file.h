// A profile set is read from its file once; from then on it is a value, and what happens to the
// file meanwhile changes nothing.
#pragma once

#include <string>

#include "services/types/admin.h"

namespace giveway::link {

// Its name is the path, which is what messages quote. Throws LinkError.
QosProfiles ReadProfileFile(const std::string& file);

}  // namespace giveway::link
