// Ranges of the ideal tier against an oracle without closed forms: it searches along the outline
// for what lies in the cone, and refines by bisection and golden section. GIVEWAY_CASES sets the
// number of placements.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sonar_ring.h"

namespace giveway::sim {
namespace {

constexpr double kTolerance_m = 1e-9;
constexpr int kSamples = 64;

int Cases() {
  if (const char* cases = std::getenv("GIVEWAY_CASES")) return std::stoi(cases);
#ifdef __OPTIMIZE__
  return 100'000;
#else
  return 5'000;
#endif
}

using Function = std::function<double(double)>;

// The minimum of a function with one valley on [low, high], ends included.
double GoldenMinimum(const Function& f, double low, double high, double* at = nullptr) {
  constexpr double kGolden = 0.6180339887498949;
  double best = std::min(f(low), f(high));
  double best_at = f(low) <= f(high) ? low : high;
  double x1 = high - kGolden * (high - low);
  double x2 = low + kGolden * (high - low);
  double f1 = f(x1);
  double f2 = f(x2);
  for (int i = 0; i < 80; ++i) {
    if (f1 <= f2) {
      if (f1 < best) best = f1, best_at = x1;
      high = x2, x2 = x1, f2 = f1;
      x1 = high - kGolden * (high - low);
      f1 = f(x1);
    } else {
      if (f2 < best) best = f2, best_at = x2;
      low = x1, x1 = x2, f1 = f2;
      x2 = low + kGolden * (high - low);
      f2 = f(x2);
    }
  }
  if (at != nullptr) *at = best_at;
  return best;
}

// Between `yes`, where f <= 0, and `no`, where it is not: the last place where it still is.
double LastNotPositive(const Function& f, double yes, double no) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (yes + no);
    (f(middle) <= 0 ? yes : no) = middle;
  }
  return yes;
}

struct View {
  Vec2 apex;
  double bearing_rad = 0;
  double half_rad = 0;
  double max_range_m = 0;

  double Excess(Vec2 point) const {
    const Vec2 offset = point - apex;
    const double angle = std::atan2(offset.y, offset.x) - bearing_rad;
    return std::abs(std::remainder(angle, 2 * kPi)) - half_rad;
  }
  double Distance(Vec2 point) const { return std::hypot(point.x - apex.x, point.y - apex.y); }
};

// The segment's points in the cone are one stretch; the distance along it has one valley.
double Search(const View& view, Vec2 from, Vec2 to) {
  const auto at = [&](double u) { return from + u * (to - from); };
  const Function excess = [&](double u) { return view.Excess(at(u)); };
  double inside = 0;
  for (int i = 1; i <= kSamples; ++i) {
    const double u = static_cast<double>(i) / kSamples;
    if (excess(u) < excess(inside)) inside = u;
  }
  if (excess(inside) > 0) {
    const double step = 1.0 / kSamples;
    GoldenMinimum(excess, std::max(0.0, inside - step), std::min(1.0, inside + step), &inside);
    if (excess(inside) > 0) return kSilence_m;
  }
  const double low = excess(0) <= 0 ? 0 : LastNotPositive(excess, inside, 0);
  const double high = excess(1) <= 0 ? 1 : LastNotPositive(excess, inside, 1);
  return GoldenMinimum([&](double u) { return view.Distance(at(u)); }, low, high);
}

// The distance along a ray to the disc's rim; beyond kMissed_m, the distance by which the ray
// misses the disc.
constexpr double kMissed_m = 1000;

double WayToRim(Vec2 apex, Vec2 unit, Vec2 centre, double radius_m) {
  const Function gap = [&](double t) {
    const Vec2 offset = apex + t * unit - centre;
    return std::sqrt(SquaredNorm(offset)) - radius_m;
  };
  double low = 0;
  double high = std::sqrt(SquaredNorm(centre - apex));  // on no ray is the nearest point further
  for (int i = 0; i < 45 && gap(high) > 0; ++i) {
    const double third = (high - low) / 3;
    if (gap(low + third) < gap(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  return gap(high) <= 0 ? LastNotPositive(gap, high, 0) : kMissed_m + gap(high);
}

// The nearest direction of the cone.
double Search(const View& view, Vec2 centre, double radius_m) {
  if (view.Distance(centre) <= radius_m) return 0;
  const Function way = [&](double angle) {
    const double direction = view.bearing_rad + angle;
    return WayToRim(view.apex, {std::cos(direction), std::sin(direction)}, centre, radius_m);
  };
  const auto angle_of = [&](int i) { return view.half_rad * (2.0 * i / kSamples - 1); };
  int best = 0;
  double best_m = way(angle_of(0));
  for (int i = 1; i <= kSamples; ++i) {
    const double way_m = way(angle_of(i));
    if (way_m < best_m) best = i, best_m = way_m;
  }
  const double least_m =
      GoldenMinimum(way, angle_of(std::max(best - 1, 0)), angle_of(std::min(best + 1, kSamples)));
  return least_m < kMissed_m ? least_m : kSilence_m;
}

// One object in an otherwise empty world, in the world frame.
struct Placement {
  enum Kind { kDisc, kBox, kWall } kind = kDisc;
  Vec2 centre_world;
  double radius_m = 0;
  std::array<Vec2, 4> corners_world;  // of a box; the first two are the ends of a wall
};

double Search(const View& view, const Placement& placed) {
  double nearest_m = kSilence_m;
  const std::array<Vec2, 4>& corners = placed.corners_world;
  if (placed.kind == Placement::kDisc) {
    nearest_m = Search(view, placed.centre_world, placed.radius_m);
  } else if (placed.kind == Placement::kWall) {
    nearest_m = Search(view, corners[0], corners[1]);
  } else {
    bool inside = true;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec2 next = corners[(i + 1) % 4];
      inside = inside && Cross(next - corners[i], view.apex - corners[i]) >= 0;
      nearest_m = std::min(nearest_m, Search(view, corners[i], next));
    }
    if (inside) nearest_m = 0;
  }
  return nearest_m <= view.max_range_m ? nearest_m : kSilence_m;
}

// Puts an object somewhere round `position`; the scene then holds it alone.
Placement Place(Random* random, int kind, Vec2 position, std::optional<Scene>* scene) {
  const double direction = random->Uniform(-kPi, kPi);
  const Vec2 away = random->Uniform(0, 6) * Vec2{std::cos(direction), std::sin(direction)};
  Placement placed{.kind = static_cast<Placement::Kind>(kind), .centre_world = position + away};
  std::vector<Wall> walls;
  if (placed.kind == Placement::kWall) {
    const Vec2 half = {random->Uniform(-4, 4), random->Uniform(-4, 4)};
    placed.corners_world = {placed.centre_world - half, placed.centre_world + half};
    walls = {{placed.corners_world[0], placed.corners_world[1]}};
  }
  scene->emplace(walls);
  if (placed.kind == Placement::kDisc) {
    placed.radius_m = random->Uniform(0.05, 0.5);
    (*scene)->AddDisc(placed.centre_world, placed.radius_m, 1);
  } else if (placed.kind == Placement::kBox) {
    const double heading = random->Uniform(-kPi, kPi);
    const Vec2 half = {random->Uniform(0.05, 1), random->Uniform(0.05, 1)};
    const Vec2 length = half.x * Vec2{std::cos(heading), std::sin(heading)};
    const Vec2 width = half.y * Vec2{-std::sin(heading), std::cos(heading)};
    const Vec2 centre = placed.centre_world;
    placed.corners_world = {centre + length - width, centre + length + width,
                            centre - length + width, centre - length - width};
    (*scene)->AddBox({centre, heading}, half, 1);
  }
  (*scene)->Index();
  return placed;
}

// They disagree about an echo only where rounding decides about the cone or the range.
bool IsCloseCall(View view, const Placement& placed) {
  view.half_rad += kTolerance_m;
  view.max_range_m += kTolerance_m;
  const bool wide = Search(view, placed) < kSilence_m;
  view.half_rad -= 2 * kTolerance_m;
  view.max_range_m -= 2 * kTolerance_m;
  return wide && Search(view, placed) == kSilence_m;
}

TEST(SonarOracle, AgreesOnRandomPlacementsOfDiscsBoxesAndWalls) {
  RobotModel profile = PioneerP3dx();
  for (SensorMount& mount : profile.sonar) mount.enabled = true;
  const SonarRing ring(profile);
  Random random(51);
  std::optional<Scene> scene;
  std::array<int, 3> echoes{};
  const int cases = Cases();
  for (int i = 0; i < cases; ++i) {
    const Pose pose = {{random.Uniform(-50, 50), random.Uniform(-50, 50)},
                       random.Uniform(-kPi, kPi)};
    const Placement placed = Place(&random, i % 3, pose.position_world, &scene);
    const std::size_t transducer = random.Next() % kSensorCount;
    const SensorMount& mount = profile.sonar[transducer];
    const View view = {.apex = ToWorld(pose, mount.position_body),
                       .bearing_rad = pose.heading_rad + mount.bearing_rad,
                       .half_rad = profile.sonar_half_angle_rad,
                       .max_range_m = profile.sonar_max_range_m};
    const double heard_m = ring.Hear(*scene, pose, 0).of[transducer];
    const double searched_m = Search(view, placed);
    if ((heard_m == kSilence_m) != (searched_m == kSilence_m)) {
      ASSERT_TRUE(IsCloseCall(view, placed)) << i << ' ' << heard_m << ' ' << searched_m;
    } else if (heard_m != kSilence_m) {
      ASSERT_NEAR(heard_m, searched_m, kTolerance_m) << i;
      ++echoes[static_cast<std::size_t>(placed.kind)];
    }
  }
  for (const int of_kind : echoes) EXPECT_GT(of_kind, cases / 40);
}

}  // namespace
}  // namespace giveway::sim
