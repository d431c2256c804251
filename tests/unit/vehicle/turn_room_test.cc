// How far a body with corners turns on the spot next to what was heard.
#include "services/vehicle/decision/turn_room.h"

#include <gtest/gtest.h>

#include <vector>

#include "services/types/robot_model.h"

namespace giveway {
namespace {

// A box of 0.6 m by 0.4 m: its corners are 0.36 m from the axle centre.
double Turn(double turn_rad, std::vector<Vec2> places, BodyShape shape = BodyShape::kBox) {
  RobotModel body = PioneerP3dx();
  body.shape = shape;
  body.box_half_m = {0.3, 0.2};
  return TurnWithinRoom(turn_rad, body, places);
}

// From one_lane 1007 with a mixed fleet: it stood next to a wall, turned away from it, and its rear
// end swept over the wall.
TEST(TurnRoom, ABoxTurnsUntilACornerIsWhereSomethingWasHeard) {
  const std::vector<Vec2> wall = {{-0.25, -0.25}};
  EXPECT_GT(Turn(1, wall), 0);
  EXPECT_LT(Turn(1, wall), 0.4);
  EXPECT_EQ(Turn(-0.3, wall), -0.3) << "the rear end turns away from it";
}

TEST(TurnRoom, IsEnoughBeyondTheCornersAndForADisc) {
  EXPECT_EQ(Turn(1, {{-0.3, -0.3}}), 1);
  EXPECT_EQ(Turn(1, {}), 1);
  EXPECT_EQ(Turn(1, {{-0.25, -0.25}}, BodyShape::kDisc), 1);
}

TEST(TurnRoom, WhatIsWithinTheBodyAlreadyForbidsNoTurnAwayFromIt) {
  const std::vector<Vec2> inside = {{-0.28, -0.2}};
  EXPECT_EQ(Turn(-0.3, inside), -0.3);
  EXPECT_EQ(Turn(0.5, inside), 0);
}

}  // namespace
}  // namespace giveway
