#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/dynamics/drive.h"
#include "tests/bench/baseline/arc_path.h"
#include "tests/bench/baseline/detour.h"
#include "tests/bench/baseline/follow.h"
#include "tests/bench/baseline/passage.h"

namespace giveway::bench {
namespace {

VehicleOptions Cruising(double cruise_m_s) {
  VehicleOptions options;
  options.profile = PioneerP3dx();
  options.cruise_m_s = cruise_m_s;
  return options;
}

double NearestOnWay(const ArcPath& path, Vec2 point) {
  double nearest_m = 1e9;
  for (double at_m = 0; at_m <= path.Length_m(); at_m += 0.005) {
    nearest_m = std::min(nearest_m, Norm(path.PoseAt(at_m).position_world - point));
  }
  return nearest_m;
}

TEST(PathAround, IsStraightWhereNothingStands) {
  const std::vector<Standing> aside = {{{2, 2}, 1}};
  const std::optional<ArcPath> path = PathAround({0, 0}, {4, 0}, aside, 0.5);
  ASSERT_TRUE(path);
  EXPECT_DOUBLE_EQ(path->Length_m(), 4.5);
  EXPECT_EQ(path->PoseAt(4.25).position_world, (Vec2{4.25, 0}));
}

TEST(PathAround, TouchesADiscOnTheNearerSide) {
  const std::vector<Standing> ahead = {{{2, 0.2}, 1}};
  const std::optional<ArcPath> path = PathAround({0, 0}, {4, 0}, ahead, 0);
  ASSERT_TRUE(path);
  EXPECT_NEAR(NearestOnWay(*path, {2, 0.2}), 1, 1e-4);
  EXPECT_LT(path->PoseAt(path->Length_m() / 2).position_world.y, -0.7);
  EXPECT_NEAR(Norm(path->PoseAt(path->Length_m()).position_world - Vec2{4, 0}), 0, 1e-9);
}

TEST(PathAround, KeepsOutOfEveryDiscOfAField) {
  Random dice(5);
  for (int turn = 0; turn < 100; ++turn) {
    std::vector<Standing> field;
    for (int i = 0; i < 25; ++i) {
      field.push_back(
          {{2.4 * (i % 5) + dice.Uniform(-0.2, 0.2), 2.4 * (i / 5) + dice.Uniform(-0.2, 0.2)},
           0.76});
    }
    const Vec2 to = {dice.Uniform(8, 11), 11.5};
    const std::optional<ArcPath> path = PathAround({dice.Uniform(-1, 3), -1.5}, to, field, 0);
    ASSERT_TRUE(path) << turn;
    EXPECT_NEAR(Norm(path->PoseAt(path->Length_m()).position_world - to), 0, 1e-6);
    for (const Standing& disc : field) {
      EXPECT_GE(NearestOnWay(*path, disc.centre_world), 0.76 - 1e-5) << turn;
    }
  }
}

TEST(FollowPath, AVehicleStaysOnABentWay) {
  const VehicleOptions options = Cruising(0.6);
  const std::vector<Standing> ahead = {{{3, 0.1}, 0.76}};
  const ArcPath path = *PathAround({0, 0}, {6, 0}, ahead, 1);
  Pose pose = path.PoseAt(0);
  WheelSpeeds wheels;
  constexpr double kTick_s = 0.05;
  double driven_m = 0;
  double farthest_off_m = 0;
  for (double speed = 0; driven_m < 6;) {
    speed = std::min(0.6, speed + 0.25 * kTick_s);
    const WheelSpeeds target = FollowPath(options.profile, path, {driven_m, speed}, pose);
    wheels = sim::MoveWheels(options.profile, wheels, target, kTick_s);
    pose = AdvanceArc(pose, TwistFromWheels(options.profile.drive, wheels), kTick_s);
    driven_m += speed * kTick_s;
    farthest_off_m =
        std::max(farthest_off_m, Norm(pose.position_world - path.PoseAt(driven_m).position_world));
  }
  EXPECT_LT(farthest_off_m, 0.03);
}

// A lane of ten metres, blocked between two units until a given step.
struct Barrier {
  std::uint32_t from_unit;
  std::uint32_t to_unit;
  std::uint32_t opens_at_step;
};

std::optional<Passage> PassBarrier(const Pace& pace, const Barrier& barrier) {
  const auto last = static_cast<std::uint32_t>(10 / pace.unit_m);
  const FreeUnits open(last / 64 + 1, ~std::uint64_t{0});
  FreeUnits closed = open;
  for (std::uint32_t unit = barrier.from_unit; unit <= barrier.to_unit; ++unit) {
    closed[unit / 64] &= ~(std::uint64_t{1} << (unit % 64));
  }
  return SoonestPassage(pace, {.arrive_unit = static_cast<std::uint32_t>(9 / pace.unit_m),
                               .last_unit = last,
                               .last_step = 1000,
                               .free_during = [&](std::uint32_t step) -> const FreeUnits& {
                                 return step < barrier.opens_at_step ? closed : open;
                               },
                               .may_stay = [](std::uint32_t, std::uint32_t) { return true; }});
}

TEST(SoonestPassage, ABarrierIsPassedAtFullSpeedTheMomentItOpens) {
  const Pace pace = PaceOf(Cruising(0.4));
  const auto metres = [&](double m) { return static_cast<std::uint32_t>(m / pace.unit_m); };
  const Barrier barrier = {metres(4), metres(5), 200};
  const std::optional<Passage> passage = PassBarrier(pace, barrier);
  ASSERT_TRUE(passage);
  EXPECT_LT(passage->units[198], barrier.from_unit);
  EXPECT_GE(passage->units[200], barrier.from_unit);
  EXPECT_EQ(passage->levels[200], pace.top);
}

TEST(SoonestPassage, SpeedsChangeNoFasterThanTheDriveAllows) {
  const Pace pace = PaceOf(Cruising(0.37));
  const auto metres = [&](double m) { return static_cast<std::uint32_t>(m / pace.unit_m); };
  const Passage passage = *PassBarrier(pace, {metres(2), metres(2.5), 300});
  for (std::size_t step = 1; step < passage.levels.size(); ++step) {
    const double gain_m_s = (static_cast<double>(passage.levels[step]) -
                             static_cast<double>(passage.levels[step - 1])) *
                            pace.level_m_s;
    EXPECT_LE(gain_m_s, 0.3 * kTicksAStep * 0.05 + 1e-9);
    EXPECT_GE(gain_m_s, -0.6 * kTicksAStep * 0.05 - 1e-9);
    EXPECT_EQ(passage.units[step] - passage.units[step - 1],
              pace.Units(passage.levels[step - 1], passage.levels[step]));
  }
  EXPECT_EQ(passage.levels.back(), 0U);
}

TEST(SoonestPassage, ThereIsNoneThroughABarrierThatStaysClosed) {
  const Pace pace = PaceOf(Cruising(0.4));
  const auto unit = static_cast<std::uint32_t>(4 / pace.unit_m);
  EXPECT_FALSE(PassBarrier(pace, {unit, unit + pace.UnitsAtMost(), 2000}));
}

}  // namespace
}  // namespace giveway::bench
