// Everything a brain remembers as bytes, and back: what a recording starts with that does not start
// with the making of its vehicle. Believes nothing: bytes that are no state a brain of these
// options can be in are refused, however they came about. Pure.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "services/types/vehicle_options.h"
#include "services/vehicle/vehicle.h"

namespace giveway {

// A kilobyte a peer, and five.
std::string BytesOf(const VehicleState& state);

// True if these are the state's bytes, in the current layout or in the older one that they are
// written in.
bool AreBytesOf(std::string_view bytes, const VehicleState& state);

// Null where the bytes are no such state.
std::unique_ptr<VehicleState> StateFrom(std::string_view bytes, const VehicleOptions& options);

}  // namespace giveway
