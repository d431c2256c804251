// Samples as JSON fields, for programs that read along: every field, in the names of fleet.idl.
// Vehicle ids of 0 are left out. Pure.
#pragma once

#include "services/runtime/json.h"
#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/motor_command.h"
#include "services/types/range_scan.h"
#include "services/types/signal.h"

namespace giveway {

void AddFields(const ReceivedBeacon& received, Json* object);
void AddFields(const VehicleStatus& status, Json* object);
void AddFields(const Truth& truth, Json* object);
void AddFields(const WorldEvent& event, Json* object);
void AddFields(const RosterEntry& entry, Json* object);
void AddFields(const SignalState& signal, Json* object);
void AddFields(const RunFigures& figures, Json* object);
void AddFields(const RangeScan& scan, Json* object);
void AddFields(const MotorCommand& command, Json* object);

}  // namespace giveway
