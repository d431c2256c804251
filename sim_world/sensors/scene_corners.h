// Where the walls of a scene end or meet: what echoes ultrasonics in addition to the faces.
// Computed once, because walls do not move. Knows no transducers.
//
// Sound that meets a wall's end or the outside of a corner is diffracted: a weak echo, whatever the
// incidence. In the inside of a right-angled corner it is reflected twice and comes straight back,
// from wherever it came (Kuc and Siegel, IEEE PAMI 9(6), 1987, section III). Two walls that cross
// with no end there make no corner.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/math/vec2.h"
#include "services/types/scenario.h"
#include "sim_world/geometry/grid.h"

namespace giveway::sim {

// Echoes transducers within its sector: counter-clockwise from one wall to the next.
struct SceneCorner {
  Vec2 at_world;
  Vec2 from_world;     // unit vector along the first wall, away from the corner
  Vec2 to_world;       // the same of the next; equal to from_world at a wall's end
  bool wide = true;    // the sector is more than a half turn
  bool round = false;  // all directions: a wall's end

  bool Answers(Vec2 point_world) const;
};

class SceneCorners {
 public:
  explicit SceneCorners(std::span<const Wall> walls);

  // Visit every wall's end and outer corner within reach_m of `centre_world`, and some others.
  template <typename Visit>
  void EdgesNear(Vec2 centre_world, double reach_m, Visit&& visit) const {
    edges_.Near(centre_world, reach_m, visit);
  }
  // The same of right-angled inner corners.
  template <typename Visit>
  void ReflectorsNear(Vec2 centre_world, double reach_m, Visit&& visit) const {
    reflectors_.Near(centre_world, reach_m, visit);
  }
  std::span<const SceneCorner> Edges() const { return edges_.corners; }
  std::span<const SceneCorner> Reflectors() const { return reflectors_.corners; }

 private:
  struct Index {
    std::vector<SceneCorner> corners;
    Grid grid;

    void Build();
    template <typename Visit>
    void Near(Vec2 centre_world, double reach_m, Visit&& visit) const {
      grid.Near(centre_world, reach_m, [&](std::uint32_t begin, std::uint32_t end) {
        for (; begin != end; ++begin) visit(corners[grid.Order()[begin]]);
      });
    }
  };

  Index edges_;
  Index reflectors_;
};

}  // namespace giveway::sim
