// Recorded samples to values and back: the same conversions as on the wire, without a wire.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "services/link/observer_link.h"
#include "services/types/motor_command.h"
#include "services/types/range_scan.h"

namespace giveway::link {

// Encapsulation header and CDR, as a writer of this type serializes it.
std::string Encode(const Beacon& beacon);
std::string Encode(const VehicleStatus& status);
std::string Encode(const Truth& truth);
std::string Encode(const WorldEvent& event);
std::string Encode(const RangeScan& scan);
std::string Encode(const SignalState& state);
std::string Encode(const RosterEntry& entry);
std::string Encode(const MotorCommand& command);
std::string Encode(const RunFigures& figures);

enum class Decoded : std::uint8_t { kYes, kUnknownTopic, kUnreadable };

// Appends the sample of this topic to what an observer would have got of it. Beacons get
// `name_valid`, for what a recorder hears in no vehicle's name is not known afterwards.
Decoded DecodeInto(std::string_view topic, std::string_view bytes, Observed* observed);
std::optional<MotorCommand> DecodeMotorCommand(std::string_view bytes);

}  // namespace giveway::link
