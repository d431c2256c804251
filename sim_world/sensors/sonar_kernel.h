// What one vehicle's 16 cones hear of the discs and segments near it: the formulas of sonar_cone.h,
// four transducers at a time in vector registers. The same bits come out of every width, because
// each lane does the reference's operations in the reference's order.
//
// Most nearby objects are behind most transducers. So the ring is cut into sectors of four
// neighbours, and only the sectors that an object reaches into hear it: about a third of all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sim_world/sensors/cone_ring.h"
#include "sim_world/sensors/scene.h"

namespace giveway::sim {

// The listening vehicle, its pose, and what it listens to.
struct Receiver {
  Vec2 position_world;
  Vec2 x_axis_world;  // of the body: one sine and cosine for all that is near
  Owner self = kNoOwner;
  double reach_m = 0;  // from the position; nothing beyond it can be heard
  Incidence incidence;
  SectorSet sectors = kEverySector;  // the others' ranges may stay as they are

  Vec2 ToBody(Vec2 point_world) const;
  Vec2 ToWorld(Vec2 point_body) const;
};

// Objects near one vehicle, in its body frame. Kept on the stack; a full list is heard and emptied.
inline constexpr std::size_t kNearListSize = 128;

// Indices of objects, appended without a branch: all four are written, and only the wanted ones
// counted. Hence the four extra elements.
template <std::size_t size>
struct Chosen {
  std::size_t count = 0;
  std::array<std::uint16_t, size + 4> of;
};

struct NearDiscs {
  std::size_t count = 0;
  alignas(32) std::array<double, kNearListSize> x;
  alignas(32) std::array<double, kNearListSize> y;
  alignas(32) std::array<double, kNearListSize> radius_m;
  Chosen<kNearListSize> in_reach;  // of all these

  void Add(Vec2 centre, double radius);
  void Clear() { count = in_reach.count = 0; }
};

struct NearSegments {
  std::size_t count = 0;
  alignas(32) std::array<double, kNearListSize> from_x;
  alignas(32) std::array<double, kNearListSize> from_y;
  alignas(32) std::array<double, kNearListSize> to_x;
  alignas(32) std::array<double, kNearListSize> to_y;
  Chosen<kNearListSize> in_reach;

  void Add(Vec2 from, Vec2 to);
  void Clear() { count = in_reach.count = 0; }
};

struct SonarKernel {
  // Add objects until the list is full, and return how many they took. Out of a stretch of discs
  // perhaps some that follow it in memory too.
  std::size_t (*gather_discs)(const Receiver& receiver, const SceneDiscs& discs, std::size_t begin,
                              std::size_t end, NearDiscs* near);
  std::size_t (*gather_walls)(const Receiver& receiver, std::span<const SceneSegment> walls,
                              std::span<const std::uint32_t> which, NearSegments* near);
  // Lower each range to that of the nearest object of the list, as RangeToDisc and RangeToSegment
  // state it, but without the limit of range.
  void (*hear_discs)(const ConeRing& ring, const Receiver& receiver, const NearDiscs& near,
                     Lanes* range_m);
  void (*hear_segments)(const ConeRing& ring, const Receiver& receiver, const NearSegments& near,
                        Lanes* range_m);
};

enum class SimdWidth { kPlain, kAvx2, kAvx512 };

// Whether this CPU supports the width. What is hidden from the C library is not hidden here.
bool HasSimd(SimdWidth width);
const SonarKernel& KernelOf(SimdWidth width);
// The widest this CPU has.
SimdWidth FastestSimd();

}  // namespace giveway::sim
