// One vehicle or spawn place of a scenario file as VehicleOptions, and the pieces of it that other
// parts of a file are made of too.
#pragma once

#include <optional>

#include "services/config/section.h"
#include "services/types/vehicle_options.h"

namespace giveway {

inline constexpr int kMaxVehicles = 16384;  // with the spawn places
inline constexpr Allowed kCoordinate{-10000, 10000, "m"};
inline constexpr Allowed kId{1, 4294967295.0};

// Applies what a section of the message Profile changes.
void ReadProfile(const std::optional<Section>& section, RobotModel* profile);
// The point of a section with x_m and y_m.
Vec2 ReadPoint(const Section& section);
// The half sides of a section Box.
Vec2 ReadBox(const Section& section);
double ReadHeading(const Section& section);
// A section Start; unusable where there is none. Without a default the heading is required.
Pose ReadStart(const std::optional<Section>& section,
               std::optional<double> default_heading_rad = std::nullopt);
std::optional<Behaviour> ReadBehaviour(const Section& section);

// `common` holds what all vehicles of the scenario share, `forced` overrides every behaviour.
VehicleOptions ReadVehicle(const Section& section, const VehicleOptions& common,
                           std::optional<Behaviour> forced);
// The same without an id: the world gives it to the vehicle that takes the place.
VehicleOptions ReadSpawn(const Section& section, const VehicleOptions& common,
                         std::optional<Behaviour> forced);

}  // namespace giveway
