// Where along its path a vehicle may be and when, by the tiles that others have booked.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "tests/bench/baseline/arc_path.h"
#include "tests/bench/baseline/passage.h"
#include "tests/bench/baseline/tiles.h"

namespace giveway::bench {

// Between the places of a path at which tiles are looked up.
inline constexpr double kSample_m = 0.02;

class Clearance {
 public:
  // Refers to all of them, and to the book as it is now. `radius_m` is of the disc that books the
  // tiles under it.
  Clearance(const ArcPath& path, const Pace& pace, const TileBook& book, double radius_m);

  std::uint32_t LastUnit() const { return last_unit_; }
  // Valid for as long as the clearance is.
  const FreeUnits& During(Step step);
  bool MayStay(std::uint32_t unit, Step step) const;

 private:
  // From one unit to another the disc touches the tile.
  struct Touch {
    Tile tile;
    std::uint32_t from_unit;
    std::uint32_t to_unit;
  };

  void FindTouches();
  void AddTouch(Tile tile, std::uint32_t first_sample, std::uint32_t last_sample);
  FreeUnits FreeUnitsOf(Step step) const;

  const ArcPath& path_;
  const Pace& pace_;
  const TileBook& book_;
  double radius_m_;
  std::uint32_t last_unit_;
  std::vector<Touch> touches_;
  std::deque<FreeUnits> known_;  // by step
};

}  // namespace giveway::bench
