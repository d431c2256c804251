// Judges whether a peer's ranges are what seven rays must find where the world's cone is exact.
//
// Every ray lies in the cone, so the nearest of seven never undercuts the exact range r. Nor can it
// overshoot r by more than the sampling costs. Outer rays run along the cone's edges and 5 degrees
// lie between rays, so what is nearest at an edge is met exactly, and any other nearest point has a
// ray within 2.5 degrees, one on either side within 5:
// - A disc of radius R with its centre D = r + R away at angle a <= 2.5 degrees off a ray is hit at
//   D cos a - sqrt(R^2 - D^2 sin^2 a). No disc slips between two rays while D sin 2.5 < R: for the
//   P3-DX of 0.25 m up to r = 5.48 m, beyond the range of 5 m.
// - The foot of a wall is met at r / cos a; the edge of a pillar by the ray that passes on the side
//   of the flatter of its two faces, tilted by t <= 45 degrees, at r cos t / cos(t + a), at most
//   1.1001 r; the face is longer than the 0.136 r this needs. Walls of the field have no free ends,
//   which could hide between rays.
//
// Peers round where the world does not. A reading outside these bounds only because a cone's edge
// grazes something is recognised by the world's own answer for cones a hair wider and narrower. Few
// may need that: an error of the cone's edges would make them many.
#pragma once

#include <cstdint>
#include <span>

#include "services/types/scenario.h"
#include "sim_world/body.h"
#include "tests/bench/world/world_peers.h"

namespace giveway::bench {

// Half angles of the wider and narrower cones differ by this from the exact one. At the far end of
// a cone it moves the edge by 0.26 mm, so that a grazed disc's chord is below 23 mm.
inline constexpr double kGraze_rad = 5e-5;
// What single precision costs along a ray, with coordinates up to 64 m (one bit: 4e-6 m).
inline constexpr double kRounding_m = 2e-5;
// Below this range single precision does not resolve on which side of a surface a transducer is.
inline constexpr double kOnSurface_m = 1e-3;

struct Agreement {
  std::uint64_t readings = 0;
  std::uint64_t on_surface = 0;     // left out
  std::uint64_t grazing = 0;        // agree for a cone a hair wider or narrower
  std::uint64_t disagreements = 0;  // none of these
  double worst_excess_m = 0;        // of a peer's range over the exact one, both in range
};

// The same vehicles at the same poses, sensed with three cones.
struct SensedBodies {
  std::span<const sim::Body> exact;
  std::span<const sim::Body> wider;
  std::span<const sim::Body> narrower;
};

// Adds one tick's comparison.
void Compare(const SensedBodies& world, std::span<const RayRanges> peer,
             std::span<const Wall> walls, Agreement* agreement);

}  // namespace giveway::bench
