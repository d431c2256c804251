// What a camera reports: where, how wide, of which class, and nothing that is hidden.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sensor.h"

namespace giveway::sim {
namespace {

TEST(Camera, NamesWhereADiscIsHowWideAndWhat) {
  Scene scene({});
  scene.AddDisc({4, 1}, 0.5, 1);
  scene.Index();
  const std::array<OwnerFacts, 2> facts = {OwnerFacts{},
                                           OwnerFacts{.seen_class = SeenClass::kVehicle}};
  const CameraScan scan = SenseCamera({.scene = scene, .facts = facts, .self = 0});
  ASSERT_EQ(scan.count, 1U);
  constexpr double kColumn_rad = 0.0018;
  EXPECT_NEAR(scan.objects[0].bearing_rad, std::atan2(1, 4), kColumn_rad);
  EXPECT_NEAR(scan.objects[0].half_width_rad, std::asin(0.5 / std::sqrt(17)), kColumn_rad);
  EXPECT_EQ(scan.objects[0].seen_class, SeenClass::kVehicle);
}

TEST(Camera, DoesNotSeeWhatIsHiddenOrOutOfItsField) {
  const std::vector<Wall> walls = {{{6, -1}, {6, 0.2}}};
  Scene scene(walls);
  scene.AddDisc({3, 1}, 0.4, 1);
  scene.AddDisc({6.3, 2.1}, 0.3, 2);  // behind the first
  scene.AddDisc({8, -0.5}, 0.3, 3);   // behind the wall
  scene.AddDisc({2, 2.5}, 0.3, 4);    // outside the field of view
  scene.AddDisc({-3, 0}, 0.3, 5);     // behind
  scene.AddDisc({16, 0.9}, 0.3, 6);   // too far
  scene.Index();
  const CameraScan scan = SenseCamera({.scene = scene, .self = 0});
  ASSERT_EQ(scan.count, 1U);
  EXPECT_NEAR(scan.objects[0].bearing_rad, std::atan2(1, 3), 0.002);
}

TEST(Camera, OfAHalfHiddenBodyItShowsTheOtherHalf) {
  Scene scene({});
  scene.AddDisc({6, 0}, 1, 1);
  scene.AddBox({{3, -1}, 0}, {0.1, 1}, 2);  // hides everything right of straight ahead
  scene.Index();
  const CameraScan scan = SenseCamera({.scene = scene, .self = 0});
  ASSERT_EQ(scan.count, 2U);
  const double half = std::asin(1.0 / 6) / 2;
  EXPECT_NEAR(scan.objects[1].bearing_rad, half, 0.002);
  EXPECT_NEAR(scan.objects[1].half_width_rad, half, 0.002);
}

}  // namespace
}  // namespace giveway::sim
