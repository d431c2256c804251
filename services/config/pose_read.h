// What a scenario says of how a vehicle knows where it is: the sensor of fixes, wheels that are not
// what the drive says, and the limit beyond which it is lost.
#pragma once

#include "services/config/section.h"
#include "services/types/robot_model.h"

namespace giveway {

// Of a profile section. What it does not write stays as it was, but for the limit: a section that
// writes a sensor or wheel errors brings the usual one, unless the file sets another.
void ReadPoseKeeping(const Section& section, RobotModel* profile);

}  // namespace giveway
