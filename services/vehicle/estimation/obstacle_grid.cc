#include "services/vehicle/estimation/obstacle_grid.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway {
namespace {

// An echo gains as much as one that is missed, and a drop-out or two, take away.
constexpr std::uint8_t kGain = 4;
constexpr std::uint8_t kLoss = 3;
// Heard twice in one place it does not fade.
constexpr std::uint8_t kFirm = 7;
static_assert(kGain < kFirm && 2 * kGain >= kFirm);
constexpr double kFadesEvery_s = 1;
// Once the way since adds a standard deviation of half a cell, all are less sure.
constexpr double kUnsure_m2 = 0.25 * ObstacleGrid::kCell_m * ObstacleGrid::kCell_m;

// Farther away an arc is wider than the vehicle: nothing is entered.
constexpr double kEnters_m = 1.4;
// Between the cells' middles and what is in them lie up to half a diagonal.
constexpr double kHalfCell_m = 0.07;
// Heard clear is what an edge would be heard from: so near on a cone's axis, and by so much less at
// its rim. A quarter within what the weakest reflector is known to be heard from.
constexpr double kClear_m = 1.1;
constexpr double kLessAtRim = 0.65;

double Wrapped(double along_m) {
  if (along_m < 0) along_m += ObstacleGrid::kWide_m;
  if (along_m >= ObstacleGrid::kWide_m) along_m -= ObstacleGrid::kWide_m;
  // Rounding: just below 0 the sum is the width itself.
  return along_m >= 0 && along_m < ObstacleGrid::kWide_m ? along_m : 0;
}

std::uint32_t CellOf(double along_m) {
  return std::min(static_cast<std::uint32_t>(along_m / ObstacleGrid::kCell_m),
                  ObstacleGrid::kSide - 1);
}

double OffsetAlong(std::uint32_t cell, double from_m) {
  double offset_m = (cell + 0.5) * ObstacleGrid::kCell_m - from_m;
  if (offset_m > ObstacleGrid::kWide_m / 2) offset_m -= ObstacleGrid::kWide_m;
  if (offset_m < -ObstacleGrid::kWide_m / 2) offset_m += ObstacleGrid::kWide_m;
  return offset_m;
}

// The cell on the far side of the torus, where the square ends.
std::uint32_t Opposite(std::uint32_t cell) {
  return (cell + ObstacleGrid::kSide / 2) % ObstacleGrid::kSide;
}

// The way a firing looks, in the grid.
struct Look {
  Vec2 apex;
  Vec2 axis;
};

Look LookOf(const HeardCone& heard) {
  const Vec2 forward = Forward(heard.grid_from_body);
  const auto turned = [&](Vec2 body) { return body.x * forward + body.y * Left(forward); };
  return {heard.grid_from_body.position_world + turned(heard.apex_body), turned(heard.axis_body)};
}

// How many cells a cone of that length reaches to either side of its apex's.
struct Bounds {
  std::uint32_t left, right, down, up;
};

Bounds BoundsOf(Vec2 axis, double half_sine, double far_m) {
  // Between the rims and the axis an arc bulges by less than a hundredth: a cell is left for that.
  const Vec2 along = far_m * Sqrt(1 - half_sine * half_sine) * axis;
  const Vec2 across = far_m * half_sine * Left(axis);
  const auto cells = [](double a, double b, double c) {
    return static_cast<std::uint32_t>(std::max({0.0, a, b, c}) / ObstacleGrid::kCell_m) + 2;
  };
  const Vec2 left = along + across;
  const Vec2 right = along - across;
  const Vec2 nose = far_m * axis;
  return {.left = cells(-left.x, -right.x, -nose.x),
          .right = cells(left.x, right.x, nose.x),
          .down = cells(-left.y, -right.y, -nose.y),
          .up = cells(left.y, right.y, nose.y)};
}

bool IsKnown(Vec2 point_body, std::span<const KnownBody> known) {
  return std::ranges::any_of(known, [&](const KnownBody& body) {
    return SquaredNorm(point_body - body.centre_body) < body.radius_m * body.radius_m;
  });
}

}  // namespace

Vec2 ObstacleGrid::OffsetOf(std::uint32_t column, std::uint32_t row, Vec2 from_grid) {
  return {OffsetAlong(column, from_grid.x), OffsetAlong(row, from_grid.y)};
}

void ObstacleGrid::ClearColumn(std::uint32_t column) {
  for (std::uint32_t row = 0; row < kSide; ++row) cells_[row * kSide + column] = 0;
}

void ObstacleGrid::ClearRow(std::uint32_t row) {
  std::fill_n(cells_.begin() + row * kSide, kSide, std::uint8_t{0});
}

void ObstacleGrid::Lose(std::uint8_t confidence) {
  for (std::uint8_t& cell : cells_) {
    cell = cell > confidence ? static_cast<std::uint8_t>(cell - confidence) : std::uint8_t{0};
  }
}

void ObstacleGrid::Move(Vec2 moved_body, double turned_rad, double unsure_m2) {
  const Vec2 forward = Forward(grid_from_body_);
  const Vec2 moved = moved_body.x * forward + moved_body.y * Left(forward);
  Vec2& at = grid_from_body_.position_world;
  const bool far = Magnitude(moved.x) >= kWide_m / 2 || Magnitude(moved.y) >= kWide_m / 2;
  const double heading_rad = WrapAngle(grid_from_body_.heading_rad + turned_rad);
  if (far || !(Magnitude(heading_rad) <= kPi)) {  // of no use to what it knew
    *this = ObstacleGrid{};
    return;
  }
  grid_from_body_.heading_rad = heading_rad;
  const std::uint32_t column = CellOf(at.x);
  const std::uint32_t row = CellOf(at.y);
  at = {Wrapped(at.x + moved.x), Wrapped(at.y + moved.y)};
  if (!active_) return;
  // What comes in on one side is what leaves on the other.
  const std::uint32_t step_x = moved.x > 0 ? 1 : kSide - 1;
  const std::uint32_t step_y = moved.y > 0 ? 1 : kSide - 1;
  for (std::uint32_t x = column; x != CellOf(at.x); x = (x + step_x) % kSide) {
    ClearColumn(Opposite(moved.x > 0 ? x : (x + step_x) % kSide));
  }
  for (std::uint32_t y = row; y != CellOf(at.y); y = (y + step_y) % kSide) {
    ClearRow(Opposite(moved.y > 0 ? y : (y + step_y) % kSide));
  }
  unsure_m2_ += unsure_m2;
  if (unsure_m2_ < kUnsure_m2) return;
  unsure_m2_ = 0;
  Lose(kLoss);
}

void ObstacleGrid::Fade(double dt_s) {
  faded_s_ += dt_s;
  if (!active_ || faded_s_ < kFadesEvery_s) return;
  faded_s_ = 0;
  for (std::uint8_t& cell : cells_) {
    if (cell > 0 && cell < kFirm) --cell;
  }
}

Pose ObstacleGrid::Before(Twist twist, double age_s) const {
  return AdvanceArc(grid_from_body_, twist, -age_s);
}

bool ObstacleGrid::IsNew(std::size_t transducer, Tick tick) {
  if (fired_[transducer] == tick) return false;
  fired_[transducer] = tick;
  return true;
}

void ObstacleGrid::StandsOn(double radius_m) {
  if (!active_) return;
  const auto reach = static_cast<std::uint32_t>(radius_m / kCell_m) + 1;
  const Vec2 at = grid_from_body_.position_world;
  for (std::uint32_t i = 0; i <= 2 * reach; ++i) {
    const std::uint32_t row = (CellOf(at.y) + kSide + i - reach) % kSide;
    for (std::uint32_t j = 0; j <= 2 * reach; ++j) {
      const std::uint32_t column = (CellOf(at.x) + kSide + j - reach) % kSide;
      if (SquaredNorm(OffsetOf(column, row, at)) < radius_m * radius_m) {
        cells_[row * kSide + column] = 0;
      }
    }
  }
}

void ObstacleGrid::Hear(const HeardCone& heard, std::span<const KnownBody> known) {
  active_ = true;
  const Look look = LookOf(heard);
  const double arc_m = heard.unsure_m + kHalfCell_m;
  const bool enters = heard.echo && heard.enters && heard.range_m <= kEnters_m;
  // Nothing nearer than this answered.
  const double free_m = heard.echo ? heard.range_m - arc_m : kClear_m;
  const double far_m = std::max(std::min(free_m, kClear_m), enters ? heard.range_m + arc_m : 0);
  if (far_m <= 0) return;
  const Vec2 now = grid_from_body_.position_world;
  const Vec2 forward = Forward(grid_from_body_);
  const Vec2 apex = {Wrapped(look.apex.x), Wrapped(look.apex.y)};
  const std::uint8_t most = heard.moves ? kFirm - 1 : kSurest;
  const double rim = heard.half_sine * heard.half_sine;
  const Bounds bounds = BoundsOf(look.axis, heard.half_sine, far_m);
  for (std::uint32_t i = 0; i <= bounds.up + bounds.down; ++i) {
    const std::uint32_t row = (CellOf(apex.y) + kSide + i - bounds.down) % kSide;
    for (std::uint32_t j = 0; j <= bounds.left + bounds.right; ++j) {
      const std::uint32_t column = (CellOf(apex.x) + kSide + j - bounds.left) % kSide;
      const Vec2 to = OffsetOf(column, row, apex);
      const double squared_m2 = SquaredNorm(to);
      if (Dot(look.axis, to) <= 0 || squared_m2 > far_m * far_m) continue;
      const double across_m = Cross(look.axis, to);
      const double off = across_m * across_m / (squared_m2 * rim);
      if (off > 1) continue;
      const double distance_m = Sqrt(squared_m2);
      std::uint8_t& cell = cells_[row * kSide + column];
      if (enters && Magnitude(distance_m - heard.range_m) <= arc_m) {
        const Vec2 from_body = OffsetOf(column, row, now);
        if (IsKnown({Dot(forward, from_body), Cross(forward, from_body)}, known)) continue;
        const auto more = std::min(static_cast<std::uint8_t>(cell + kGain), most);
        cell = std::max(cell, more);
      } else if (distance_m < free_m && distance_m < kClear_m * (1 - kLessAtRim * off)) {
        cell = cell > kLoss ? static_cast<std::uint8_t>(cell - kLoss) : std::uint8_t{0};
      }
    }
  }
}

std::uint8_t ObstacleGrid::At(Vec2 point_body) const {
  const Vec2 forward = Forward(grid_from_body_);
  const Vec2 offset = point_body.x * forward + point_body.y * Left(forward);
  constexpr double kReach_m = kWide_m / 2 - kCell_m;
  if (Magnitude(offset.x) > kReach_m || Magnitude(offset.y) > kReach_m) return 0;
  const Vec2 at = grid_from_body_.position_world + offset;
  return cells_[CellOf(Wrapped(at.y)) * kSide + CellOf(Wrapped(at.x))];
}

void ObstacleGrid::AddTo(StateHash* hash) const {
  if (!active_) return;
  hash->Add(grid_from_body_.position_world.x);
  hash->Add(grid_from_body_.position_world.y);
  hash->Add(grid_from_body_.heading_rad);
  hash->Add(unsure_m2_);
  hash->Add(faded_s_);
  for (std::uint32_t i = 0; i < cells_.size(); i += 8) {
    std::uint64_t eight = 0;
    for (std::uint32_t j = 0; j < 8; ++j) eight |= std::uint64_t{cells_[i + j]} << 8 * j;
    if (eight == 0) continue;
    hash->Add(i);
    hash->Add(eight);
  }
}

}  // namespace giveway
