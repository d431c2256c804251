#include "sim_world/virtual/generators.h"

#include <algorithm>
#include <array>

#include "services/types/math/math.h"
#include "sim_world/virtual/layout.h"

namespace giveway::sim {
namespace {

constexpr std::array kGenerators = {
    Generator{"crossing", "four roads meet, all vehicles drive straight across", 0.45, 2,
              MakeCrossing},
    Generator{"roundabout", "four roads meet in a ring", 0.4, 3, MakeRoundabout},
    Generator{"corridor", "a narrow passage with traffic from both ends", 0.25, 0, MakeCorridor,
              true},
    Generator{"merge", "a ramp joins a road", 0.4, 2, MakeMerge},
    Generator{"warehouse", "racks, aisles, a road along either side", 0.3, 4, MakeWarehouse},
    Generator{"swarm", "random starts and goals in an open field", 0.45, 2, MakeSwarm},
    Generator{"convoy", "one lane in one direction, at different speeds", 0.45, 2, MakeConvoy},
    Generator{"door", "a door of 0.9 to 1.8 m, traffic in both directions", 0.3, 3.2, MakeDoor},
    Generator{"one_lane", "a passage one body wide, traffic in both directions", 0.3, kMouths_m,
              MakeOneLane, true},
    Generator{"antipodal", "a circle, each vehicle to the opposite side", 0.4, 2, MakeAntipodal},
    Generator{"parking", "bays along an aisle, one half drives in, the other out", 0.4, 4,
              MakeParking},
    Generator{"shared_goal", "two or three want the same place: one of them arrives", 0.45, 2,
              MakeSharedGoal},
    Generator{"mixed_yard", "pallets, posts and walls close to the paths, and a moving obstacle",
              0.4, 2, MakeMixedYard},
};

}  // namespace

std::span<const Generator> Generators() { return kGenerators; }

const Generator* FindGenerator(std::string_view name) {
  const auto found = std::ranges::find(kGenerators, name, &Generator::name);
  return found == kGenerators.end() ? nullptr : &*found;
}

double ThroughMetres(const Generator& generator, const Scenario& scenario) {
  if (!generator.passage || scenario.walls.empty()) return generator.through_m;
  const Wall& wall = scenario.walls.front();
  return generator.through_m + Norm(wall.to_world - wall.from_world);
}

}  // namespace giveway::sim
