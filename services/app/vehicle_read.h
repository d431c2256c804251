// One vehicle of a scenario file as VehicleOptions.
#pragma once

#include <optional>

#include "services/app/section.h"
#include "services/types/vehicle_options.h"

namespace giveway::app {

inline constexpr Allowed kCoordinate{-10000, 10000, "m"};
inline constexpr Allowed kId{1, 4294967295.0};

// Applies what a section of the message Profile changes.
void ReadProfile(const std::optional<Section>& section, VehicleProfile* profile);
// The point of a section with x_m and y_m.
Vec2 ReadPoint(const Section& section);
std::optional<Behaviour> ReadBehaviour(const Section& section);

// `common` holds what all vehicles of the scenario share, `forced` overrides every behaviour.
VehicleOptions ReadVehicle(const Section& section, const VehicleOptions& common,
                           std::optional<Behaviour> forced);

}  // namespace giveway::app
