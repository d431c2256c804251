// Samples as JSON fields, for programs that read along: every field, in the names of fleet.idl.
// Vehicle ids of 0 are left out. Pure.
#pragma once

#include "services/observer/fleet/json_object.h"
#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/motor_command.h"
#include "services/types/range_scan.h"
#include "services/types/signal.h"

namespace giveway {

void AddFields(const ReceivedBeacon& received, JsonObject* object);
void AddFields(const VehicleStatus& status, JsonObject* object);
void AddFields(const Truth& truth, JsonObject* object);
void AddFields(const WorldEvent& event, JsonObject* object);
void AddFields(const RosterEntry& entry, JsonObject* object);
void AddFields(const SignalState& signal, JsonObject* object);
void AddFields(const RunFigures& figures, JsonObject* object);
void AddFields(const RangeScan& scan, JsonObject* object);
void AddFields(const MotorCommand& command, JsonObject* object);

}  // namespace giveway
