// Memory of obstacles: where ultrasonics have heard something, kept until it is heard clear from
// there, leaves the grid, or is too unsure. A square of cells about the vehicle, which scrolls with
// it in steps of a cell; its axes are those of the start pose, and it moves by wheel odometry
// alone, so that a pose fix moves nothing in it. Fixed size, no clock. Knows no peers: the caller
// leaves out echoes that a known peer explains. Decides nothing. README.md in this folder explains
// the numbers.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/robot_model.h"
#include "services/types/state_hash.h"

namespace giveway {

// What one firing of one transducer says: where it was when it fired, in the body frame of now.
struct HeardCone {
  Vec2 apex_body;
  Vec2 axis_body;        // unit vector
  double half_sine = 0;  // of half the opening
  bool echo = false;     // false: it heard nothing
  double range_m = 0;    // only of an echo
  double unsure_m = 0;   // the range may be off by so much
  bool enters = false;   // the echo is of something to be kept
  bool moves = false;    // of something that moves: it is forgotten soon
};

// A disc that is known to be there and is no obstacle to be kept.
struct KnownBody {
  Vec2 centre_body;
  double radius_m = 0;
};

class ObstacleGrid {
 public:
  // Cells: a row is one word of bits; 2.4 m to each side, echoes are entered up to 1.4 m off.
  static constexpr std::uint32_t kSide = 48;
  static constexpr double kCell_m = 0.1;  // as wide as a cone 0.2 m off
  static constexpr double kWide_m = kSide * kCell_m;
  // Confidence of a cell: from 0, nothing heard, to kSurest; it counts from kHeld on.
  static constexpr std::uint8_t kSurest = 12;
  static constexpr std::uint8_t kHeld = 3;
  // Of what was heard near a transducer. There a cell is as wide as a cone: an edge that is turned
  // out of one cone is between it and the next, not gone, though the middle of its cell is in one.
  // So it is soon this sure, and then cleared by cones that hold all of the cell alone.
  static constexpr std::uint8_t kSurestNear = 15;

  // The vehicle came `moved_body` on, in the frame it had before, and turned. `unsure_m2`: the
  // variance that this adds to where things are to it.
  void Move(Vec2 moved_body, double turned_rad, double unsure_m2);
  // Time passes: what was heard only once is forgotten.
  void Fade(double dt_s);
  // What lies under the own body, a disc of that radius, is not there.
  void StandsOn(double radius_m);
  // Takes one firing in: cells on the arc of its echo gain, those it has heard clear lose.
  void Hear(const HeardCone& heard, std::span<const KnownBody> known);

  // Of `tick`, a transducer's last firing: true once.
  bool IsNew(std::size_t transducer, Tick tick);

  // True once anything was taken in.
  bool IsActive() const { return active_; }
  // The confidence of the cell that holds the point; 0 outside the grid.
  std::uint8_t At(Vec2 point_body) const;
  // Visits the middle of every cell that counts, in the body frame.
  template <typename Visit>
  void Held(Visit&& visit) const {
    const Vec2 forward = heading_.forward_world;
    for (std::uint32_t row = 0; row < kSide; ++row) {
      for (std::uint64_t left = some_[row]; left != 0; left &= left - 1) {
        const auto column = static_cast<std::uint32_t>(std::countr_zero(left));
        if (cells_[row * kSide + column] < kHeld) continue;
        const Vec2 offset = OffsetOf(column, row, at_grid_);
        visit(Vec2{Dot(forward, offset), Cross(forward, offset)});
      }
    }
  }

  void AddTo(StateHash* hash) const;

 private:
  friend struct StateFields;  // services/snapshot

  // From a point of the grid to the middle of a cell, the shorter distance round the torus.
  static Vec2 OffsetOf(std::uint32_t column, std::uint32_t row, Vec2 from_grid);
  Vec2 Rotated(Vec2 body) const {
    return body.x * heading_.forward_world + body.y * Left(heading_.forward_world);
  }
  void Put(std::uint32_t column, std::uint32_t row, std::uint8_t confidence);
  void Lose(std::uint8_t confidence, std::uint8_t below);
  void ClearColumn(std::uint32_t column);
  void ClearRow(std::uint32_t row);
  void Gain(const HeardCone& heard, Vec2 apex, Vec2 axis, std::span<const KnownBody> known);
  void Clear(const HeardCone& heard, Vec2 apex, Vec2 axis);

  // The cell of column x, row y; the square is a torus, and the vehicle's place in it wraps round.
  std::array<std::uint8_t, std::size_t{kSide} * kSide> cells_{};
  std::array<std::uint64_t, kSide> some_{};  // by row: bit x where cell x is not 0
  Vec2 at_grid_{kWide_m / 2, kWide_m / 2};   // both in [0, kWide_m)
  CachedHeading heading_;                    // in the grid
  double unsure_m2_ = 0;                     // gained since the cells last lost by it
  double faded_s_ = 0;                       // passed since they last faded
  std::array<Tick, kSensorCount> fired_{};
  bool active_ = false;
};

}  // namespace giveway
