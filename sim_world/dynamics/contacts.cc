#include "sim_world/dynamics/contacts.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "services/types/math/math.h"
#include "sim_world/geometry/approach.h"
#include "sim_world/geometry/geometry.h"

namespace giveway::sim {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

bool IsMovingAfter(const Motion& motion, double t_s) {
  return Moves(motion) && motion.stop_s > t_s;
}
bool IsMovingAfter(const Leaf& leaf, double t_s) { return Moves(leaf) && leaf.stop_s > t_s; }

bool IsMovingAfter(const Collidables& collidables, std::size_t thing, double t_s) {
  return collidables.IsLeaf(thing) ? IsMovingAfter(collidables.LeafOf(thing), t_s)
                                   : IsMovingAfter(collidables.motions[thing], t_s);
}

Outline OutlineOf(const Collidables& collidables, std::size_t thing, double t_s) {
  Outline outline = collidables.IsLeaf(thing) ? OutlineAt(collidables.LeafOf(thing), t_s)
                                              : OutlineAt(collidables.motions[thing], t_s);
  if (!IsMovingAfter(collidables, thing, t_s)) outline.velocity_world = {};
  return outline;
}

// Whether a, at its hit with b, would close in on b if b stood still.
bool ClosesIn(const Collidables& collidables, std::size_t a, std::size_t b, double t_s) {
  const Outline of_a = OutlineOf(collidables, a, t_s);
  Outline of_b = OutlineOf(collidables, b, t_s);
  of_b.velocity_world = {};
  return GapRate(of_a, of_b, NearestBetween(of_a, of_b)) < 0;
}

void StopThing(Collidables* collidables, std::size_t thing, double t_s) {
  double& stop_s = collidables->IsLeaf(thing) ? collidables->LeafOf(thing).stop_s
                                              : collidables->motions[thing].stop_s;
  stop_s = std::min(stop_s, t_s);
}

}  // namespace

Contacts::Contacts(std::span<const Wall> walls)
    : walls_(walls.begin(), walls.end()), wall_grid_(walls) {}

// A wall in several cells is visited several times.
template <typename Visit>
void Contacts::WallsNear(const Motion& motion, double travel_m, const Visit& visit) const {
  const Vec2 position = motion.start_world.position_world;
  const double reach_m = motion.radius_m + travel_m + kTouch_m;
  wall_grid_.Near(position, reach_m, [&](std::uint32_t wall) {
    const Vec2 nearest = NearestOnSegment(walls_[wall].from_world, walls_[wall].to_world, position);
    if (SquaredNorm(position - nearest) <= reach_m * reach_m) visit(wall);
  });
}

bool Contacts::TouchesWall(const Motion& motion) const {
  bool touches = false;
  WallsNear(motion, 0, [&](std::uint32_t wall) {
    touches = touches || GapAt(motion, walls_[wall], 0) <= kTouch_m;
  });
  return touches;
}

void Contacts::Gather(std::span<const NearPair> pairs, const Collidables& collidables, double dt_s,
                      const ParallelFor& parallel) {
  by_walls_.Make(
      collidables.motions.size(), parallel, [&](std::size_t i, std::vector<Candidate>* near) {
        const Motion& motion = collidables.motions[i];
        if (collidables.present[i] == 0 || !Moves(motion)) return;
        const std::size_t begin = near->size();
        WallsNear(motion, TravelBound(motion, dt_s), [&](std::uint32_t wall) {
          const auto known = [&](const Candidate& other) { return other.hit.b == wall; };
          if (std::any_of(near->begin() + static_cast<std::ptrdiff_t>(begin), near->end(), known)) {
            return;
          }
          near->push_back({{kNever, static_cast<std::uint32_t>(i), true, wall}, kNone, kNone});
        });
      });
  candidates_.assign(by_walls_.All().begin(), by_walls_.All().end());
  for (const NearPair& pair : pairs) {
    if (pair.apart_m > kTouch_m || collidables.IsLeaf(pair.b))
      continue;  // leaves do not stop each other
    candidates_.push_back({{kNever, pair.a, false, pair.b}, kNone, kNone});
  }
}

// Links the candidates of each thing into a chain.
void Contacts::Chain(std::size_t count) {
  first_of_.assign(count, kNone);
  for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
    Candidate& candidate = candidates_[i];
    candidate.next_of_a = std::exchange(first_of_[candidate.hit.a], i);
    if (!candidate.hit.wall) candidate.next_of_b = std::exchange(first_of_[candidate.hit.b], i);
  }
}

double Contacts::NextHit(const Hit& candidate, const Collidables& collidables,
                         double from_s) const {
  const auto [t_s, a, wall, b] = candidate;
  const bool moving =
      IsMovingAfter(collidables, a, from_s) || (!wall && IsMovingAfter(collidables, b, from_s));
  if (!moving) return kNever;
  std::optional<double> hit_s;
  if (wall) {
    hit_s = FirstContact(collidables.motions[a], walls_[b], from_s, dt_s_);
  } else if (collidables.IsLeaf(a)) {
    hit_s = FirstContact(collidables.motions[b], collidables.LeafOf(a), from_s, dt_s_);
  } else {
    hit_s = FirstContact(collidables.motions[a], collidables.motions[b], from_s, dt_s_);
  }
  return hit_s.value_or(kNever);
}

bool Contacts::Later(const Entry& x, const Entry& y) {
  return std::tie(x.hit.t_s, x.hit.a, x.hit.wall, x.hit.b) >
         std::tie(y.hit.t_s, y.hit.a, y.hit.wall, y.hit.b);
}

void Contacts::Enqueue(std::uint32_t candidate) {
  const Hit& hit = candidates_[candidate].hit;
  if (hit.t_s == kNever) return;
  queue_.push_back({hit, candidate});
  std::push_heap(queue_.begin(), queue_.end(), Later);
}

void Contacts::Stop(const Hit& hit, Collidables* collidables) {
  if (hit.wall) {
    StopThing(collidables, hit.a, hit.t_s);
    return;
  }
  const bool vehicles = collidables->IsBody(hit.a) && collidables->IsBody(hit.b);
  const bool stop_a = vehicles || ClosesIn(*collidables, hit.a, hit.b, hit.t_s);
  const bool stop_b = vehicles || ClosesIn(*collidables, hit.b, hit.a, hit.t_s);
  // Rounding may deny both: then both stop, or the hit would repeat forever.
  if (stop_a || !stop_b) StopThing(collidables, hit.a, hit.t_s);
  if (stop_b || !stop_a) StopThing(collidables, hit.b, hit.t_s);
}

void Contacts::FindHitsAgain(std::uint32_t thing, double from_s, const Collidables& collidables) {
  for (std::uint32_t i = first_of_[thing]; i != kNone;) {
    Candidate& candidate = candidates_[i];
    const double before_s =
        std::exchange(candidate.hit.t_s, NextHit(candidate.hit, collidables, from_s));
    if (candidate.hit.t_s != before_s) Enqueue(i);
    i = !candidate.hit.wall && candidate.hit.b == thing ? candidate.next_of_b : candidate.next_of_a;
  }
}

std::span<const Hit> Contacts::StopAll(std::span<const NearPair> pairs, double dt_s,
                                       const ParallelFor& parallel, Collidables* collidables) {
  dt_s_ = dt_s;
  hits_.clear();
  queue_.clear();
  Gather(pairs, *collidables, dt_s, parallel);
  const auto find = [&](std::size_t begin, std::size_t end) {
    for (; begin != end; ++begin) {
      Hit& hit = candidates_[begin].hit;
      hit.t_s = NextHit(hit, *collidables, 0);
    }
  };
  parallel(candidates_.size(), std::ref(find));
  Chain(collidables->Count());
  for (std::uint32_t i = 0; i < candidates_.size(); ++i) Enqueue(i);
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), Later);
    const Entry earliest = queue_.back();
    queue_.pop_back();
    if (candidates_[earliest.candidate].hit.t_s != earliest.hit.t_s) continue;
    // Every hit stops something that moved, so this terminates.
    candidates_[earliest.candidate].hit.t_s = kNever;
    Stop(earliest.hit, collidables);
    hits_.push_back(earliest.hit);
    FindHitsAgain(earliest.hit.a, earliest.hit.t_s, *collidables);
    if (!earliest.hit.wall) FindHitsAgain(earliest.hit.b, earliest.hit.t_s, *collidables);
  }
  return hits_;
}

}  // namespace giveway::sim
