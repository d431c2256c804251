#include "sim_world/sensors/cone_ring.h"

#include <algorithm>
#include <optional>
#include <span>

#include "services/types/math/vec2.h"

namespace giveway::sim {
namespace {

// A line lies this far outside its cones: rounding, and kOnTheWall_m, must not lose an object.
constexpr double kConeSlack_m = 1e-6;

// `axis` turned by the half angle to its right (side -1) or left (+1).
Vec2 Edge(const Cone& cone, double side) {
  return cone.cos_half * cone.axis + side * cone.sin_half * Left(cone.axis);
}

// The inward normal of the outermost edge on that side: all other edges lie inside it. None where
// the cones look in all directions.
std::optional<Vec2> InwardNormal(std::span<const Cone> cones, double side) {
  for (const Cone& outermost : cones) {
    const Vec2 inward = -side * Left(Edge(outermost, side));
    const auto inside = [&](const Cone& cone) {
      return Dot(inward, Edge(cone, side)) >= -1e-15 && Dot(inward, Edge(cone, -side)) >= -1e-15;
    };
    if (std::ranges::all_of(cones, inside)) return inward;
  }
  return std::nullopt;
}

void Bound(std::span<const Cone> cones, double side, std::size_t sector, SectorLines* lines) {
  const std::optional<Vec2> inward = InwardNormal(cones, side);
  if (!inward) return;  // the line as it is bounds nothing
  double least_m = kSilence_m;
  for (const Cone& cone : cones) least_m = std::min(least_m, Dot(*inward, cone.apex));
  lines->normal_x[sector] = inward->x;
  lines->normal_y[sector] = inward->y;
  lines->least_m[sector] = least_m - kConeSlack_m;
}

}  // namespace

ConeRing RingOf(const std::array<Cone, kSensorCount>& cones_body) {
  ConeRing ring;
  ring.cos_half = cones_body.front().cos_half;
  ring.sin_half = cones_body.front().sin_half;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    ring.apex_x.of[i] = cones_body[i].apex.x;
    ring.apex_y.of[i] = cones_body[i].apex.y;
    ring.axis_x.of[i] = cones_body[i].axis.x;
    ring.axis_y.of[i] = cones_body[i].axis.y;
  }
  const std::span<const Cone> all = cones_body;
  for (std::size_t sector = 0; sector < kSectorCount; ++sector) {
    const auto cones = all.subspan(sector * kSectorSize, kSectorSize);
    Bound(cones, -1, sector, &ring.lines[0]);
    Bound(cones, 1, sector, &ring.lines[1]);
  }
  return ring;
}

}  // namespace giveway::sim
