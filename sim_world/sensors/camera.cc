// Camera: a one-line image, a tenth of a degree per column. Each column shows what is nearest
// there; an object in at least one column is seen, from its first column to its last. Walls hide
// what is behind them and are not reported.
#include <algorithm>
#include <array>

#include "services/types/math/math.h"
#include "sim_world/sensors/ray_fan.h"
#include "sim_world/sensors/sensor.h"

namespace giveway::sim {
namespace {

constexpr std::size_t kColumns = 601;
constexpr double kColumn_rad = 2 * kCameraHalfAngle_rad / (kColumns - 1);

struct Seen {
  Owner owner = kNoOwner;
  std::size_t first = 0;  // columns
  std::size_t last = 0;
  double range_m = 0;  // of its nearest column
};

// All objects in the image. Each step to another object is a new column, so `seen` is large enough.
std::size_t Recognise(std::span<const RayHit> columns, std::span<Seen> seen) {
  std::size_t count = 0;
  for (std::size_t column = 0; column < columns.size(); ++column) {
    const RayHit& hit = columns[column];
    if (!hit.hit || hit.owner == kNoOwner) continue;
    const auto known = std::ranges::find(seen.first(count), hit.owner, &Seen::owner);
    if (known == seen.begin() + static_cast<std::ptrdiff_t>(count)) {
      seen[count++] = {hit.owner, column, column, hit.range_m};
    } else {
      known->last = column;
      known->range_m = std::min(known->range_m, hit.range_m);
    }
  }
  return count;
}

}  // namespace

CameraScan SenseCamera(const SensorView& view) {
  static const RayFan fan(-kCameraHalfAngle_rad, kColumn_rad, kColumns);
  std::array<RayHit, kColumns> columns;
  fan.Cast(view, kCameraRange_m, columns);
  std::array<Seen, kColumns> all;
  const std::span<Seen> seen = std::span(all).first(Recognise(columns, all));
  std::ranges::sort(seen, [](const Seen& a, const Seen& b) {
    return a.range_m != b.range_m ? a.range_m < b.range_m : a.owner < b.owner;
  });
  CameraScan scan{.vehicle = view.vehicle, .epoch = view.epoch, .tick = view.tick};
  scan.count = static_cast<std::uint32_t>(std::min(seen.size(), kMaxDetections));
  for (std::size_t i = 0; i < scan.count; ++i) {
    const double from = fan.Bearing(seen[i].first);
    const double to = fan.Bearing(seen[i].last);
    scan.objects[i] = {.seen_class = view.FactsOf(seen[i].owner).seen_class,
                       .bearing_rad = (from + to) / 2,
                       .half_width_rad = (to - from + kColumn_rad) / 2};
  }
  return scan;
}

}  // namespace giveway::sim
