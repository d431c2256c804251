// Places where something was heard, recently or just now, as the rules and the steering ask for
// them: the cells of the obstacle grid that count, near the vehicle, in the body frame. Empty for
// exact ultrasonics, whose last echo says all there is, and for the lecture's behaviours.
#pragma once

#include <array>
#include <optional>

#include "services/vehicle/estimation/obstacle_grid.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// True if this vehicle remembers what it hears.
bool Remembers(const VehicleOptions& options);

// Takes the firings of this tick into the grid, but for the echoes of peers that are believed.
void RememberEchoes(const OwnView& s, const PeersNow& near, ObstacleGrid* grid);

// Lists what the grid holds near the vehicle.
void ListPlaces(const ObstacleGrid& grid, const OwnView& s, HeardPlaces* places);

// How far the own shell may go straight on, in that direction from the axle centre, before it is at
// a heard place; empty if there is none. Places behind it, or already to its side, do not count.
std::optional<double> FreeOfPlaces(Vec2 direction_body, const Situation& s);

}  // namespace giveway
