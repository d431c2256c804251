// The contacts of one tick: stops everything that would touch something and still close in, in
// order of time. Knows motions, not vehicles; the caller decides whether a contact is new.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/types/parallel.h"
#include "services/types/scenario.h"
#include "sim_world/dynamics/collidables.h"
#include "sim_world/geometry/neighbours.h"
#include "sim_world/geometry/parallel_collector.h"
#include "sim_world/geometry/wall_grid.h"

namespace giveway::sim {

struct Hit {
  double t_s = 0;
  std::uint32_t a = 0;  // a thing; if both are things, the higher number
  bool wall = false;
  std::uint32_t b = 0;  // the other thing, or the wall
};

class Contacts {
 public:
  explicit Contacts(std::span<const Wall> walls);

  // Sets the stops of `collidables` for a tick of dt_s. `pairs` names all that may touch in it.
  // Returns the hits in order of time, and at one time the lowest number first, so that the order
  // of search has no effect.
  //
  // Two vehicles that meet both stop. Against anything else only what closes in stops: a vehicle
  // may leave a cart that pushes it, and a vehicle next to a door does not hold it.
  std::span<const Hit> StopAll(std::span<const NearPair> pairs, double dt_s,
                               const ParallelFor& parallel, Collidables* collidables);

  std::span<const Wall> Walls() const { return walls_; }
  // Whether the motion, at its start, touches a wall.
  bool TouchesWall(const Motion& motion) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  // Two that are near enough to touch in this tick.
  struct Candidate {
    Hit hit;                  // its next one; t_s infinite if there is none
    std::uint32_t next_of_a;  // the next candidate of the same thing, kNone after the last
    std::uint32_t next_of_b;
  };
  // A hit in the queue; stale once its candidate has another.
  struct Entry {
    Hit hit;
    std::uint32_t candidate;
  };

  template <typename Visit>
  void WallsNear(const Motion& motion, double travel_m, const Visit& visit) const;
  void Gather(std::span<const NearPair> pairs, const Collidables& collidables, double dt_s,
              const ParallelFor& parallel);
  void Chain(std::size_t count);
  double NextHit(const Hit& candidate, const Collidables& collidables, double from_s) const;
  void Enqueue(std::uint32_t candidate);
  void Stop(const Hit& hit, Collidables* collidables);
  void FindHitsAgain(std::uint32_t thing, double from_s, const Collidables& collidables);

  static bool Later(const Entry& x, const Entry& y);

  std::vector<Wall> walls_;
  WallGrid wall_grid_;
  double dt_s_ = 0;
  ParallelCollector<Candidate> by_walls_;
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> first_of_;  // candidate of each thing
  std::vector<Entry> queue_;             // a heap, earliest on top
  std::vector<Hit> hits_;
};

}  // namespace giveway::sim
