// Makes scenarios of a kind, sized by vehicles and varied by seed. Only layouts that can be solved:
// starts and goals at least two metres apart (one vehicle per 4 m^2), goals off the paths of others
// or in the order they are reached, or, as in convoy and antipodal, where every vehicle can move
// aside. Two lanes are two bodies and half a metre wide; door and one_lane are passed one by one.
// Every vehicle can arrive except those that share a goal (arriving.h), and this is known before
// the run. The same values give the same scenario on every machine.
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
  double most_radius_m =
      0.25;  // bodies that get through everywhere, and past each other where two lanes are
  // The longest of its places in which only one can be at a time: so long, and in a passage as much
  // more as the first of its walls is long, which is drawn.
  double through_m = 2;
  Scenario (*make)(const Size& size) = nullptr;
  bool passage = false;
};

std::span<const Generator> Generators();
// Null if there is none of that name.
const Generator* FindGenerator(std::string_view name);
// How long the place is in which only one can be at a time, of a scenario that the generator made.
double ThroughMetres(const Generator& generator, const Scenario& scenario);

// Four roads meet; every vehicle drives straight across.
Scenario MakeCrossing(const Size& size);
// Four roads meet in a ring, driven counter-clockwise.
Scenario MakeRoundabout(const Size& size);
// A narrow passage with traffic from both ends.
Scenario MakeCorridor(const Size& size);
// A ramp joins a road.
Scenario MakeMerge(const Size& size);
// Racks, aisles between them, a road along either side.
Scenario MakeWarehouse(const Size& size);
// Random starts and goals in an open field.
Scenario MakeSwarm(const Size& size);
// One lane in one direction, at different speeds.
Scenario MakeConvoy(const Size& size);

// A door one to two bodies wide in a wall, with traffic in both directions.
Scenario MakeDoor(const Size& size);
// A passage in which no two pass each other, with traffic from both ends.
Scenario MakeOneLane(const Size& size);
// A circle on which every vehicle has its goal on the opposite side.
Scenario MakeAntipodal(const Size& size);
// A car park: one half drives in, the other out, and some into the bay of one that leaves.
Scenario MakeParking(const Size& size);
// Two or three vehicles with the same goal: one of them can arrive.
Scenario MakeSharedGoal(const Size& size);
// A swarm among pallets, posts and ends of walls close to the paths, and a moving obstacle.
Scenario MakeMixedYard(const Size& size);

}  // namespace giveway::sim
