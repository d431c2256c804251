// Everything a sensor can hear or see at one instant, as bare shapes: discs, boxes and segments in
// the world frame, indexed so that what is near is found fast. Walls are given once; the rest is
// put in anew each time. Knows no vehicles: a shape has an owner number, and a sensor skips its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/pose.h"
#include "services/types/scenario.h"
#include "sim_world/grid.h"

namespace giveway::sim {

// Whose a shape is: the caller's numbering; walls are nobody's.
using Owner = std::uint32_t;
inline constexpr Owner kNoOwner = 0xffffffff;

// Structure of arrays, in the order of the grid.
struct SceneDiscs {
  std::span<const double> x_world;
  std::span<const double> y_world;
  std::span<const double> radius_m;
  std::span<const Owner> owner;
};

struct SceneSegment {
  Vec2 from_world;
  Vec2 to_world;
  Owner owner = kNoOwner;
};

class Scene {
 public:
  explicit Scene(std::span<const Wall> walls);

  // Forgets everything but the walls.
  void Clear();
  void AddDisc(Vec2 centre_world, double radius_m, Owner owner);
  // Four segments; a point inside is at distance 0 from the box.
  void AddBox(const Pose& world_from_box, Vec2 half_m, Owner owner);
  void AddSegment(Vec2 from_world, Vec2 to_world, Owner owner);
  // To be called after the last Add and before the first question.
  void Index();

  SceneDiscs Discs() const;
  // Visits stretches [begin, end) of Discs() that hold every disc whose surface is within reach_m
  // of `centre_world`, and some others.
  template <typename Visit>
  void DiscsNear(Vec2 centre_world, double reach_m, Visit&& visit) const;
  // Visits every segment (walls, box sides, leaves) within reach_m of `centre_world`, and some
  // others; one may be visited more than once.
  template <typename Visit>
  void SegmentsNear(Vec2 centre_world, double reach_m, Visit&& visit) const;
  // Owner of the box other than `self` that holds the point; kNoOwner if none does.
  Owner BoxAround(Vec2 point_world, Owner self) const;
};

}  // namespace giveway::sim
