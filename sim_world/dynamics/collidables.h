// Everything that can be hit within one tick, under one numbering: first the bodies of vehicles,
// then obstacles, then the leaves of doors. Walls have a separate numbering.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_world/geometry/motion.h"

namespace giveway::sim {

struct Collidables {
  std::size_t bodies = 0;       // the first motions are those of vehicles, this many
  std::vector<Motion> motions;  // of bodies and obstacles
  std::vector<Leaf> leaves;
  std::vector<std::uint8_t> present;  // by number; what is absent cannot be hit

  std::size_t Count() const { return motions.size() + leaves.size(); }
  bool IsBody(std::size_t thing) const { return thing < bodies; }
  bool IsLeaf(std::size_t thing) const { return thing >= motions.size(); }
  const Leaf& LeafOf(std::size_t thing) const { return leaves[thing - motions.size()]; }
  Leaf& LeafOf(std::size_t thing) { return leaves[thing - motions.size()]; }
};

}  // namespace giveway::sim
