// Whether what a world senses for a vehicle, or a vehicle asks of its wheels, can be believed:
// every number finite and in a range that anything on wheels keeps to, an epoch and a tick, and
// nothing that was measured later than it was sent. Pure.
#pragma once

#include <optional>

#include "services/types/motor_command.h"
#include "services/types/pose_sensing.h"
#include "services/types/range_scan.h"
#include "services/types/refusal.h"
#include "services/types/sensor_scan.h"
#include "services/types/signal.h"

namespace giveway::link {

// The first field that is not in range, nothing if all are.
std::optional<FieldFault> FaultOf(const RangeScan& scan);
std::optional<FieldFault> FaultOf(const RadarScan& scan);
std::optional<FieldFault> FaultOf(const LidarScan& scan);
std::optional<FieldFault> FaultOf(const CameraScan& scan);
std::optional<FieldFault> FaultOf(const PoseFix& fix);
std::optional<FieldFault> FaultOf(const SignalState& state);
std::optional<FieldFault> FaultOf(const MotorCommand& command);

}  // namespace giveway::link
