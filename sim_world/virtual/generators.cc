#include "sim_world/virtual/generators.h"

#include <algorithm>
#include <array>

#include "services/types/math/math.h"
#include "sim_world/virtual/layout.h"

namespace giveway::sim {
namespace {

constexpr std::array kGenerators = {
    Generator{"crossing", "four roads meet, everyone drives straight across", MakeCrossing},
    Generator{"roundabout", "four roads meet in a ring", MakeRoundabout},
    Generator{"corridor", "a narrow passage with traffic from both ends", MakeCorridor},
    Generator{"merge", "a ramp joins a road", MakeMerge},
    Generator{"warehouse", "racks, aisles, a road along either side", MakeWarehouse},
    Generator{"swarm", "random starts and goals in an open field", MakeSwarm},
    Generator{"convoy", "one lane, everyone the same way, at different speeds", MakeConvoy},
};

}  // namespace

std::span<const Generator> Generators() { return kGenerators; }

const Generator* FindGenerator(std::string_view name) {
  const auto found = std::ranges::find(kGenerators, name, &Generator::name);
  return found == kGenerators.end() ? nullptr : &*found;
}

}  // namespace giveway::sim
