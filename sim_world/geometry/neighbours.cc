#include "sim_world/geometry/neighbours.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway::sim {
namespace {

// Beyond any vehicle and what it drives in a tick.
constexpr double kLarge_m = 1.5;
constexpr double kSmallestBodyCell_m = 0.5;

void KeepIfNear(const Ball& a, const Ball& b, double margin_m, std::vector<NearPair>* pairs) {
  const double reach_m = a.reach_m + b.reach_m;
  const double squared_m2 = SquaredNorm(a.centre_world - b.centre_world);
  const double most_m = reach_m + margin_m;
  if (squared_m2 > most_m * most_m) return;
  pairs->push_back(
      {std::max(a.thing, b.thing), std::min(a.thing, b.thing), Sqrt(squared_m2) - reach_m});
}

}  // namespace

void Neighbours::Sort(std::span<const Ball> balls) {
  unsorted_.clear();
  large_.clear();
  centres_.clear();
  widest_m_ = 0;
  for (const Ball& ball : balls) {
    if (ball.reach_m > kLarge_m) {
      large_.push_back(ball);
      continue;
    }
    unsorted_.push_back(ball);
    centres_.push_back(ball.centre_world);
    widest_m_ = std::max(widest_m_, ball.reach_m);
  }
  grid_.Rebuild(centres_, std::max(kSmallestBodyCell_m, 2 * widest_m_));
  small_.resize(unsorted_.size());
  for (std::size_t i = 0; i < small_.size(); ++i) small_[i] = unsorted_[grid_.Order()[i]];
}

void Neighbours::PairSmall(std::size_t at, double margin_m, std::vector<NearPair>* pairs) const {
  const Ball& ball = small_[at];
  grid_.Near(ball.centre_world, ball.reach_m + widest_m_ + margin_m,
             [&](std::uint32_t begin, std::uint32_t end) {
               for (std::size_t i = begin; i < std::min<std::size_t>(end, at); ++i) {
                 KeepIfNear(ball, small_[i], margin_m, pairs);
               }
             });
}

void Neighbours::PairLarge(std::size_t at, double margin_m, std::vector<NearPair>* pairs) const {
  const Ball& ball = large_[at];
  grid_.Near(ball.centre_world, ball.reach_m + widest_m_ + margin_m,
             [&](std::uint32_t begin, std::uint32_t end) {
               for (; begin != end; ++begin) KeepIfNear(ball, small_[begin], margin_m, pairs);
             });
  for (std::size_t i = 0; i < at; ++i) KeepIfNear(ball, large_[i], margin_m, pairs);
}

void Neighbours::Find(std::span<const Ball> balls, double margin_m, const ParallelFor& parallel) {
  Sort(balls);
  pairs_.Make(small_.size() + large_.size(), parallel,
              [&](std::size_t i, std::vector<NearPair>* pairs) {
                if (i < small_.size()) {
                  PairSmall(i, margin_m, pairs);
                } else {
                  PairLarge(i - small_.size(), margin_m, pairs);
                }
              });
}

}  // namespace giveway::sim
