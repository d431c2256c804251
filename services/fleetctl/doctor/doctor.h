// The verb `fleetctl doctor`: the host a fleet runs on, examined before or while it runs. Starts
// nothing and sends nothing; only with `fix` something is changed. Values in; the exit code out.
#pragma once

#include "services/fleetctl/doctor/doctor_options.h"

namespace giveway::fleetctl {

// 0 nothing found, 1 something (left, with `fix`), 2 could not examine. Throws InputError,
// LinkError.
int RunDoctor(const DoctorOptions& options);

}  // namespace giveway::fleetctl
