#include "services/vehicle/estimation/obstacle_grid.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/bits.h"

namespace giveway {
namespace {

// An echo gains as much as one that is missed, and a drop-out or two, take away.
constexpr std::uint8_t kGain = 4;
constexpr std::uint8_t kLoss = 3;
// So near, where it is heard twice before the vehicle has passed or turned, it is as sure as can
// be.
constexpr double kNear_m = 0.25;
constexpr std::uint8_t kGainNear = 8;
static_assert(2 * kGainNear > ObstacleGrid::kSurest);
// Heard twice in one place it does not fade.
constexpr std::uint8_t kFirm = 7;
static_assert(kGain < kFirm && 2 * kGain >= kFirm);
constexpr double kFadesEvery_s = 1;  // by one: an echo that came once is gone after two seconds
// Once the displacement since adds a standard deviation of half a cell, all cells are less sure.
constexpr double kUnsure_m2 = 0.25 * ObstacleGrid::kCell_m * ObstacleGrid::kCell_m;

// Further away an arc is wider than the vehicle: nothing is entered.
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

std::uint8_t LessBy(std::uint8_t cell, std::uint8_t loss) {
  return cell > loss ? static_cast<std::uint8_t>(cell - loss) : std::uint8_t{0};
}

// The cell on the far side of the torus, where the square ends.
std::uint32_t Opposite(std::uint32_t cell) {
  return (cell + ObstacleGrid::kSide / 2) % ObstacleGrid::kSide;
}

// How many cells a shape reaches to either side of that of its apex.
struct CellSpan {
  int left, right, down, up;
};

// Of a part of a cone's: between two ranges, rim to rim. Between the rims and the axis an arc
// bulges by less than a hundredth, for which a cell is left.
CellSpan CellSpanOf(Vec2 axis, double half_sine, double near_m, double far_m) {
  const Vec2 along = Sqrt(1 - half_sine * half_sine) * axis;
  const Vec2 across = half_sine * Left(axis);
  const std::array<Vec2, 5> corners = {near_m * (along + across), near_m * (along - across),
                                       far_m * (along + across), far_m * (along - across),
                                       far_m * axis};
  Vec2 low = corners[0];
  Vec2 high = corners[0];
  for (const Vec2 corner : corners) {
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
    high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
  }
  const auto cells = [](double m) { return static_cast<int>(m / ObstacleGrid::kCell_m); };
  return {cells(low.x) - 1, cells(high.x) + 1, cells(low.y) - 1, cells(high.y) + 1};
}

// The cell so many steps on, round the torus.
std::uint32_t StepFrom(std::uint32_t cell, int steps) {
  return (cell + ObstacleGrid::kSide + static_cast<std::uint32_t>(steps)) % ObstacleGrid::kSide;
}

// Bits of the columns from `left` to `right` steps on.
std::uint64_t ColumnsFrom(std::uint32_t cell, const CellSpan& bounds) {
  constexpr std::uint64_t kAll = (std::uint64_t{1} << ObstacleGrid::kSide) - 1;
  const auto count = static_cast<std::uint32_t>(bounds.right - bounds.left + 1);
  if (count >= ObstacleGrid::kSide) return kAll;
  const std::uint64_t run = (std::uint64_t{1} << count) - 1;
  const std::uint32_t first = StepFrom(cell, bounds.left);
  return (run << first | run >> (ObstacleGrid::kSide - first)) & kAll;
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

void ObstacleGrid::Put(std::uint32_t column, std::uint32_t row, std::uint8_t confidence) {
  const std::uint64_t bit = std::uint64_t{1} << column;
  cells_[row * kSide + column] = confidence;
  some_[row] = confidence != 0 ? some_[row] | bit : some_[row] & ~bit;
}

void ObstacleGrid::ClearColumn(std::uint32_t column) {
  for (std::uint32_t row = 0; row < kSide; ++row) {
    if (some_[row] != 0) Put(column, row, 0);
  }
}

void ObstacleGrid::ClearRow(std::uint32_t row) {
  if (some_[row] == 0) return;
  std::fill_n(cells_.begin() + std::ptrdiff_t{row} * kSide, kSide, std::uint8_t{0});
  some_[row] = 0;
}

// All cells below that.
void ObstacleGrid::Lose(std::uint8_t confidence, std::uint8_t below) {
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (const std::size_t column : BitsOf(some_[row])) {
      const std::uint8_t cell = cells_[std::size_t{row} * kSide + column];
      if (cell < below) Put(static_cast<std::uint32_t>(column), row, LessBy(cell, confidence));
    }
  }
}

void ObstacleGrid::Move(Vec2 moved_body, double turned_rad, double unsure_m2) {
  if (!active_) return;
  const Vec2 moved = Rotated(moved_body);
  const double heading_rad = WrapAngle(heading_.heading_rad + turned_rad);
  const bool far = Magnitude(moved.x) >= kWide_m / 2 || Magnitude(moved.y) >= kWide_m / 2;
  if (far || !(Magnitude(heading_rad) <= kPi)) {  // of no use to what it knew
    *this = ObstacleGrid{};
    return;
  }
  heading_.Follow({.heading_rad = heading_rad});
  const std::uint32_t column = CellOf(at_grid_.x);
  const std::uint32_t row = CellOf(at_grid_.y);
  at_grid_ = {Wrapped(at_grid_.x + moved.x), Wrapped(at_grid_.y + moved.y)};
  // What comes in on one side is what leaves on the other.
  const int step_x = moved.x > 0 ? 1 : -1;
  const int step_y = moved.y > 0 ? 1 : -1;
  for (std::uint32_t x = column; x != CellOf(at_grid_.x); x = StepFrom(x, step_x)) {
    ClearColumn(Opposite(moved.x > 0 ? x : StepFrom(x, step_x)));
  }
  for (std::uint32_t y = row; y != CellOf(at_grid_.y); y = StepFrom(y, step_y)) {
    ClearRow(Opposite(moved.y > 0 ? y : StepFrom(y, step_y)));
  }
  unsure_m2_ += unsure_m2;
  if (unsure_m2_ < kUnsure_m2) return;
  const double times = std::min(unsure_m2_ / kUnsure_m2, double{kSurest});
  const auto losses = static_cast<std::uint8_t>(times);
  unsure_m2_ = losses < kSurest ? unsure_m2_ - losses * kUnsure_m2 : 0;
  Lose(std::min<std::uint8_t>(losses * kLoss, kSurestNear), kSurestNear + 1);
}

void ObstacleGrid::Fade(double dt_s) {
  if (!active_) return;
  faded_s_ += dt_s;
  if (faded_s_ < kFadesEvery_s) return;
  faded_s_ = 0;
  Lose(1, kFirm);
}

bool ObstacleGrid::IsNew(std::size_t transducer, Tick tick) {
  if (fired_[transducer] == tick) return false;
  fired_[transducer] = tick;
  return true;
}

void ObstacleGrid::StandsOn(double radius_m) {
  if (!active_) return;
  const int reach = static_cast<int>(radius_m / kCell_m) + 1;
  const CellSpan bounds = {-reach, reach, -reach, reach};
  const std::uint64_t columns = ColumnsFrom(CellOf(at_grid_.x), bounds);
  for (int i = -reach; i <= reach; ++i) {
    const std::uint32_t row = StepFrom(CellOf(at_grid_.y), i);
    for (const std::size_t at : BitsOf(some_[row] & columns)) {
      const auto column = static_cast<std::uint32_t>(at);
      if (SquaredNorm(OffsetOf(column, row, at_grid_)) < radius_m * radius_m) Put(column, row, 0);
    }
  }
}

void ObstacleGrid::Hear(const HeardCone& heard, std::span<const KnownBody> known) {
  active_ = true;
  const Vec2 place = at_grid_ + Rotated(heard.apex_body);
  const Vec2 apex = {Wrapped(place.x), Wrapped(place.y)};
  const Vec2 axis = Rotated(heard.axis_body);
  Clear(heard, apex, axis);
  if (heard.echo && heard.enters && heard.range_m <= kEnters_m) Gain(heard, apex, axis, known);
}

// Those nearer than the echo that would have been heard.
void ObstacleGrid::Clear(const HeardCone& heard, Vec2 apex, Vec2 axis) {
  const double arc_m = heard.unsure_m + kHalfCell_m;
  const double far_m = heard.echo ? std::min(heard.range_m - arc_m, kClear_m) : kClear_m;
  if (far_m <= 0) return;
  const double rim = heard.half_sine * heard.half_sine;
  const CellSpan bounds = CellSpanOf(axis, heard.half_sine, 0, far_m);
  const std::uint64_t columns = ColumnsFrom(CellOf(apex.x), bounds);
  for (int i = bounds.down; i <= bounds.up; ++i) {
    const std::uint32_t row = StepFrom(CellOf(apex.y), i);
    for (const std::size_t at : BitsOf(some_[row] & columns)) {
      const auto column = static_cast<std::uint32_t>(at);
      const Vec2 to = OffsetOf(column, row, apex);
      const double squared_m2 = SquaredNorm(to);
      if (Dot(axis, to) <= 0 || squared_m2 > far_m * far_m) continue;
      const std::uint8_t cell = cells_[row * kSide + column];
      const double half_m = cell > kSurest ? kHalfCell_m : 0;
      const double across_m = Magnitude(Cross(axis, to)) + half_m;
      const double off = across_m * across_m / (squared_m2 * rim);
      const double clear_m = kClear_m * (1 - kLessAtRim * off);
      if (off > 1 || squared_m2 > clear_m * clear_m) continue;
      Put(column, row, LessBy(cell, kLoss));
    }
  }
}

// Those on the arc.
void ObstacleGrid::Gain(const HeardCone& heard, Vec2 apex, Vec2 axis,
                        std::span<const KnownBody> known) {
  const double arc_m = heard.unsure_m + kHalfCell_m;
  const double near_m = std::max(0.0, heard.range_m - arc_m);
  const double far_m = heard.range_m + arc_m;
  const double rim = heard.half_sine * heard.half_sine;
  const bool near = heard.range_m <= kNear_m && !heard.moves;
  const std::uint8_t most = heard.moves ? kFirm - 1 : (near ? kSurestNear : kSurest);
  const std::uint8_t gain = near ? kGainNear : kGain;
  const CellSpan bounds = CellSpanOf(axis, heard.half_sine, near_m, far_m);
  for (int i = bounds.down; i <= bounds.up; ++i) {
    const std::uint32_t row = StepFrom(CellOf(apex.y), i);
    for (int j = bounds.left; j <= bounds.right; ++j) {
      const std::uint32_t column = StepFrom(CellOf(apex.x), j);
      const Vec2 to = OffsetOf(column, row, apex);
      const double squared_m2 = SquaredNorm(to);
      if (squared_m2 > far_m * far_m || squared_m2 < near_m * near_m || Dot(axis, to) <= 0)
        continue;
      const double across_m = Cross(axis, to);
      if (across_m * across_m > rim * squared_m2) continue;
      const Vec2 from_body = OffsetOf(column, row, at_grid_);
      const Vec2 forward = heading_.forward_world;
      if (IsKnown({Dot(forward, from_body), Cross(forward, from_body)}, known)) continue;
      const std::uint8_t cell = cells_[row * kSide + column];
      const auto more = std::min(static_cast<std::uint8_t>(cell + gain), most);
      Put(column, row, std::max(cell, more));
    }
  }
}

std::uint8_t ObstacleGrid::At(Vec2 point_body) const {
  const Vec2 offset = Rotated(point_body);
  // Nearer to the rim the cell may be that of the opposite side.
  constexpr double kReach_m = kWide_m / 2 - kCell_m;
  if (Magnitude(offset.x) > kReach_m || Magnitude(offset.y) > kReach_m) return 0;
  const Vec2 at = at_grid_ + offset;
  return cells_[CellOf(Wrapped(at.y)) * kSide + CellOf(Wrapped(at.x))];
}

void ObstacleGrid::AddTo(StateHash* hash) const {
  if (!active_) return;
  hash->Add(at_grid_.x);
  hash->Add(at_grid_.y);
  hash->Add(heading_.heading_rad);
  hash->Add(unsure_m2_);
  hash->Add(faded_s_);
  for (std::uint32_t row = 0; row < kSide; ++row) {
    if (some_[row] == 0) continue;
    hash->Add(row);
    hash->Add(some_[row]);
    for (const std::size_t column : BitsOf(some_[row])) {
      hash->Add(std::uint32_t{cells_[std::size_t{row} * kSide + column]});
    }
  }
}

}  // namespace giveway
