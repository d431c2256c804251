// Makes scenarios of a kind, sized by vehicles and varied by seed. Only layouts that can be solved:
// starts and goals at least two metres apart (one vehicle per 4 m^2), goals off the ways of others
// or in the order they are reached, aisles of two bodies and half a metre. The same values give the
// same scenario anywhere.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "services/types/scenario.h"
#include "sim_world/virtual/layout.h"

namespace giveway::sim {

struct Generator {
  std::string_view name;
  std::string_view description;
  Scenario (*make)(Size size);
};

std::span<const Generator> Generators();
// Null if there is none of that name.
const Generator* FindGenerator(std::string_view name);

// Four roads meet; everyone drives straight across.
Scenario MakeCrossing(Size size);
// Four roads meet in a ring, driven counter-clockwise.
Scenario MakeRoundabout(Size size);
// A narrow passage with traffic from both ends.
Scenario MakeCorridor(Size size);
// A ramp joins a road.
Scenario MakeMerge(Size size);
// Racks, aisles between them, a road along either side.
Scenario MakeWarehouse(Size size);
// Random starts and goals in an open field.
Scenario MakeSwarm(Size size);
// One lane, everyone the same way, at different speeds.
Scenario MakeConvoy(Size size);

}  // namespace giveway::sim
