#include "tests/bench/baseline/clearance.h"

#include <algorithm>
#include <utility>

namespace giveway::bench {
namespace {

void Close(std::uint32_t from_unit, std::uint32_t to_unit, FreeUnits* open) {
  for (std::uint32_t unit = from_unit; unit <= to_unit;) {
    const std::uint32_t bit = unit % 64;
    const std::uint32_t count = std::min(64 - bit, to_unit - unit + 1);
    const std::uint64_t ones = count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
    (*open)[unit / 64] &= ~(ones << bit);
    unit += count;
  }
}

}  // namespace

Clearance::Clearance(const ArcPath& path, const Pace& pace, const TileBook& book, double radius_m)
    : path_(path),
      pace_(pace),
      book_(book),
      radius_m_(radius_m),
      last_unit_(static_cast<std::uint32_t>(path.Length_m() / pace.unit_m)) {
  FindTouches();
}

void Clearance::FindTouches() {
  std::vector<std::pair<Tile, std::uint32_t>> seen;
  std::vector<Tile> tiles;
  const auto samples = static_cast<std::uint32_t>(path_.Length_m() / kSample_m) + 1;
  for (std::uint32_t sample = 0; sample <= samples; ++sample) {
    book_.TilesUnder(path_.PoseAt(sample * kSample_m).position_world, radius_m_ + kSample_m / 2,
                     &tiles);
    for (const Tile tile : tiles) {
      if (book_.IsEverTaken(tile)) seen.emplace_back(tile, sample);
    }
  }
  std::ranges::sort(seen);
  for (std::size_t first = 0; first < seen.size();) {
    std::size_t last = first;
    while (last + 1 < seen.size() && seen[last + 1].first == seen[first].first &&
           seen[last + 1].second == seen[last].second + 1) {
      ++last;
    }
    AddTouch(seen[first].first, seen[first].second, seen[last].second);
    first = last + 1;
  }
}

// At least as long as what may be driven in a step: who is free before and after it is free within.
void Clearance::AddTouch(Tile tile, std::uint32_t first_sample, std::uint32_t last_sample) {
  const double half_sample = kSample_m / 2;
  const double from_m = std::max(0.0, first_sample * kSample_m - half_sample);
  const double to_m = last_sample * kSample_m + half_sample;
  const double missing_m = std::max(0.0, pace_.UnitsAtMost() * pace_.unit_m - (to_m - from_m));
  const double from = std::max(0.0, (from_m - missing_m / 2) / pace_.unit_m);
  const double to = (to_m + missing_m / 2) / pace_.unit_m + 1;
  touches_.push_back({.tile = tile,
                      .from_unit = static_cast<std::uint32_t>(from),
                      .to_unit = std::min(last_unit_, static_cast<std::uint32_t>(to))});
}

FreeUnits Clearance::FreeUnitsOf(Step step) const {
  FreeUnits open(last_unit_ / 64 + 1, ~std::uint64_t{0});
  for (const Touch& touch : touches_) {
    if (touch.from_unit <= last_unit_ && book_.IsTaken(touch.tile, step)) {
      Close(touch.from_unit, touch.to_unit, &open);
    }
  }
  const std::uint32_t beyond = (last_unit_ + 1) % 64;
  if (beyond != 0) open.back() &= (std::uint64_t{1} << beyond) - 1;
  return open;
}

const FreeUnits& Clearance::During(Step step) {
  while (known_.size() <= step) known_.push_back(FreeUnitsOf(static_cast<Step>(known_.size())));
  return known_[step];
}

bool Clearance::MayStay(std::uint32_t unit, Step step) const {
  return std::ranges::all_of(touches_, [&](const Touch& touch) {
    const bool touched = touch.from_unit <= unit && unit <= touch.to_unit;
    return !touched || book_.IsFreeFrom(touch.tile, step + 1);
  });
}

}  // namespace giveway::bench
