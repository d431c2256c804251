// Everything a sensor can hear or see at one instant, as bare shapes: discs, boxes and segments in
// the world frame, indexed so that near ones are found fast. Walls are given once; the rest is
// inserted again each time. Knows no vehicles: a shape has an owner number, and a sensor skips its
// own. Once indexed it is read-only, and several threads may query it at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/math/pose.h"
#include "services/types/scenario.h"
#include "sim_world/geometry/grid.h"
#include "sim_world/geometry/wall_grid.h"
#include "sim_world/sensors/scene_corners.h"

namespace giveway::sim {

// Identifies the owner of a shape, in the caller's numbering; walls have none.
using Owner = std::uint32_t;
inline constexpr Owner kNoOwner = 0xffffffff;

// Structure of arrays, in the order of the grid. Behind the last are three more, too far away to
// be sensed, so that discs may be read four at a time.
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

struct SceneBox {
  Vec2 centre_world;
  Vec2 x_axis_world;  // unit vector along its length
  Vec2 half_m;        // half length and half width
  Owner owner = kNoOwner;
  std::array<Vec2, 4> corners_world;  // counter-clockwise

  SceneSegment Side(std::size_t i) const {
    return {corners_world[i], corners_world[(i + 1) % 4], owner};
  }
  // The rim belongs to the box.
  bool Holds(Vec2 point_world) const;
};

class Scene {
 public:
  explicit Scene(std::span<const Wall> walls);

  // Removes everything but the walls.
  void Clear();
  void AddDisc(Vec2 centre_world, double radius_m, Owner owner);
  // Four segments; a point inside is at distance 0 from the box.
  void AddBox(const Pose& world_from_box, Vec2 half_m, Owner owner);
  void AddSegment(Vec2 from_world, Vec2 to_world, Owner owner);
  // Call after the last Add and before the first query.
  void Index();

  SceneDiscs Discs() const;
  // Visits half-open ranges of Discs() that contain every disc whose surface is within reach_m of
  // `centre_world`, and some others.
  template <typename Visit>
  void DiscsNear(Vec2 centre_world, double reach_m, Visit&& visit) const {
    disc_grid_.Near(centre_world, reach_m + largest_radius_m_, visit);
  }
  // Visits every segment (walls, box sides, leaves) within reach_m of `centre_world`, and some
  // others, as a SceneSegment; one may be visited more than once.
  template <typename Visit>
  void SegmentsNear(Vec2 centre_world, double reach_m, Visit&& visit) const {
    WallsNear(centre_world, reach_m, [&](std::uint32_t wall) { visit(walls_[wall]); });
    LooseSegmentsNear(centre_world, reach_m, visit);
  }
  // Owner of the box other than `self` that holds the point; kNoOwner if none does.
  Owner BoxAround(Vec2 point_world, Owner self) const;

  // The parts of SegmentsNear, for callers that must not get a wall twice: indices into Walls(),
  // one perhaps more than once, and everything that is not a wall, each once.
  template <typename Visit>
  void WallsNear(Vec2 centre_world, double reach_m, Visit&& visit) const {
    wall_grid_.Near(centre_world, reach_m, visit);
  }
  std::span<const SceneSegment> Walls() const { return walls_; }
  // Of the walls alone.
  const SceneCorners& Corners() const { return corners_; }
  // WallsNear for a reach of up to kListedReach_m, looked up directly, each wall once.
  static constexpr double kListedReach_m = 5.5;  // the ultrasonics of a P3-DX and more
  std::span<const std::uint32_t> WallsListedAt(Vec2 centre_world) const {
    return listed_walls_.At(centre_world);
  }
  template <typename Visit>
  void LooseSegmentsNear(Vec2 centre_world, double reach_m, Visit&& visit) const {
    BoxesNear(centre_world, reach_m, [&](const SceneBox& box) {
      for (std::size_t side = 0; side < box.corners_world.size(); ++side) visit(box.Side(side));
    });
    LeavesNear(centre_world, reach_m, visit);
  }
  // The same of what was given to AddSegment alone.
  template <typename Visit>
  void LeavesNear(Vec2 centre_world, double reach_m, Visit&& visit) const {
    leaf_grid_.Near(centre_world, reach_m + longest_half_leaf_m_,
                    [&](std::uint32_t begin, std::uint32_t end) {
                      for (; begin != end; ++begin) visit(leaves_[leaf_grid_.Order()[begin]]);
                    });
  }
  // Visits every box within reach_m of `centre_world`, and some others, each once.
  template <typename Visit>
  void BoxesNear(Vec2 centre_world, double reach_m, Visit&& visit) const {
    box_grid_.Near(centre_world, reach_m + largest_half_diagonal_m_,
                   [&](std::uint32_t begin, std::uint32_t end) {
                     for (; begin != end; ++begin) visit(boxes_[box_grid_.Order()[begin]]);
                   });
  }

 private:
  std::vector<SceneSegment> walls_;
  WallGrid wall_grid_;
  WallGrid listed_walls_;
  SceneCorners corners_;

  // As added; the sorted copies below are what is read.
  std::vector<Vec2> disc_centres_;
  std::vector<double> disc_radii_m_;
  std::vector<Owner> disc_owners_;
  double largest_radius_m_ = 0;
  Grid disc_grid_;
  std::vector<double> sorted_x_;
  std::vector<double> sorted_y_;
  std::vector<double> sorted_radius_m_;
  std::vector<Owner> sorted_owner_;

  std::vector<Vec2> box_centres_;
  std::vector<SceneBox> boxes_;
  double largest_half_diagonal_m_ = 0;
  Grid box_grid_;

  std::vector<Vec2> leaf_middles_;
  std::vector<SceneSegment> leaves_;
  double longest_half_leaf_m_ = 0;
  Grid leaf_grid_;
};

}  // namespace giveway::sim
