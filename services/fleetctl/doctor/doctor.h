// The verb `fleetctl doctor`: examines the host of a fleet, before or while it runs. Starts nothing
// and sends nothing; changes something only with `fix`. Values in; the exit code out.
#pragma once

#include "services/fleetctl/doctor/doctor_options.h"

namespace giveway::fleetctl {

// 0 nothing found, 1 something (with `fix`: something is left), 2 could not examine. Throws
// InputError, LinkError.
int RunDoctor(const DoctorOptions& options);

}  // namespace giveway::fleetctl
