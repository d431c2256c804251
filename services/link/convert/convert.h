// Our values to wire types and back, field by field. Text longer than its bound is cut. FromWire is
// false if the sample has an enumerator this build does not know, more elements than its bound, or
// NaN or infinity where the IDL says "finite". Nothing else is judged: NaN goes through as NaN.
// Of a refused sample, fields that could not be converted keep their value.
#pragma once

#include "services/link/fastdds/fastdds_version.h"
#include "services/types/admin.h"
#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/motor_command.h"
#include "services/types/pose_sensing.h"
#include "services/types/range_scan.h"
#include "services/types/refusal.h"
#include "services/types/sensor_scan.h"
#include "services/types/signal.h"

namespace giveway::link {

wire::Beacon ToWire(const Beacon& beacon);
wire::RangeScan ToWire(const RangeScan& scan);
wire::RadarScan ToWire(const RadarScan& scan);
wire::LidarScan ToWire(const LidarScan& scan);
wire::CameraScan ToWire(const CameraScan& scan);
wire::PoseFix ToWire(const PoseFix& fix);
wire::SignalState ToWire(const SignalState& state);
wire::MotorCommand ToWire(const MotorCommand& command);
wire::Status ToWire(const VehicleStatus& status);
wire::Join ToWire(const JoinRequest& request);
wire::Roster ToWire(const RosterEntry& entry);
wire::Order ToWire(const AdminRequest& order);
wire::Answer ToWire(const AdminAnswer& answer);
wire::Truth ToWire(const Truth& truth);
wire::Event ToWire(const WorldEvent& event);
wire::Figures ToWire(const RunFigures& figures);

// What a beacon that arrived is worth.
struct Arrival {
  bool crc_valid = false;  // the checksum of fleet.idl, set by ToWire(Beacon)
  bool readable = false;   // as the other conversions' result
  std::uint32_t crc = 0;   // that its fields have
};

Arrival FromWire(const wire::Beacon& sample, Beacon& beacon);
// What FromWire found of a sample it refused, for the log; an empty field if nothing.
FieldFault FaultOf(const wire::Beacon& sample);
FieldFault FaultOf(const wire::MotorCommand& sample);
bool FromWire(const wire::RangeScan& sample, RangeScan& scan);
bool FromWire(const wire::RadarScan& sample, RadarScan& scan);
bool FromWire(const wire::LidarScan& sample, LidarScan& scan);
bool FromWire(const wire::CameraScan& sample, CameraScan& scan);
bool FromWire(const wire::PoseFix& sample, PoseFix& fix);
bool FromWire(const wire::SignalState& sample, SignalState& state);
bool FromWire(const wire::MotorCommand& sample, MotorCommand& command);
bool FromWire(const wire::Status& sample, VehicleStatus& status);
bool FromWire(const wire::Join& sample, JoinRequest& request);
bool FromWire(const wire::Roster& sample, RosterEntry& entry);
bool FromWire(const wire::Order& sample, AdminRequest& order);
bool FromWire(const wire::Answer& sample, AdminAnswer& answer);
bool FromWire(const wire::Truth& sample, Truth& truth);
bool FromWire(const wire::Event& sample, WorldEvent& event);
bool FromWire(const wire::Figures& sample, RunFigures& figures);

}  // namespace giveway::link
