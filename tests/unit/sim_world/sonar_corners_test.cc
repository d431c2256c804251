// Diffraction at edges and reflection from inner corners, as heard by the tiers above ideal.
#include "sim_world/sensors/sonar_corners.h"

#include <gtest/gtest.h>

#include "services/types/math/math.h"
#include "tests/unit/sim_world/sonar_vehicle.h"

namespace giveway::sim {
namespace {

// From here transducer 3 points along 10 degrees.
const Vec2 kApex = {0.166, 0.027};

Vec2 Before3(double range_m, double off_deg) {
  const double bearing_rad = Radians(10 + off_deg);
  return kApex + range_m * Vec2{Cos(bearing_rad), Sin(bearing_rad)};
}

RangeReading HeardBy3(SonarTier tier, std::vector<Wall> walls) {
  OneVehicle vehicle(Faultless(tier), walls);
  RangeReading reading;
  for (std::uint32_t tick = 1; tick <= 10; ++tick) reading = vehicle.Sense(tick)[3];
  return reading;
}

// A wall whose near end is in front of transducer 3, and which leads straight away from it, so that
// its face returns no echo.
RangeReading HeardOfEnd(SonarTier tier, double range_m, double off_deg = 0) {
  const Vec2 end = Before3(range_m, off_deg);
  return HeardBy3(tier, {{end, Before3(range_m + 3, off_deg)}});
}

TEST(SonarCorners, AWallsEndIsHeardEdgeOnFromAsFarAsTheTierHears) {
  for (const SonarTier tier : {SonarTier::kTypical, SonarTier::kP3dx, SonarTier::kCrosstalk}) {
    const double reach_m = EdgeReach(tier);
    const RangeReading near = HeardOfEnd(tier, reach_m - 0.01);
    ASSERT_EQ(near.kind, Echo::kEcho);
    EXPECT_NEAR(near.range_m, reach_m - 0.01, 1e-9);
    EXPECT_EQ(HeardOfEnd(tier, reach_m + 0.01).kind, Echo::kClear);
  }
}

TEST(SonarCorners, TowardsTheRimOfTheConeAnEndIsHeardFromNearerOnly) {
  const double rim_m = EdgeReachOff(EdgeReach(SonarTier::kTypical), 1);
  EXPECT_LT(rim_m, 0.5 * EdgeReach(SonarTier::kTypical));
  EXPECT_EQ(HeardOfEnd(SonarTier::kTypical, rim_m, 14.9).kind, Echo::kEcho);
  EXPECT_EQ(HeardOfEnd(SonarTier::kTypical, rim_m + 0.05, 14.9).kind, Echo::kClear);
}

TEST(SonarCorners, IdealHearsWhatItHeardBefore) {
  EXPECT_EQ(EdgeReach(SonarTier::kIdeal), 0);
  // The nearest point in the cone, wherever in it and however far: an edge like any other.
  for (const double off_deg : {0.0, 14.0}) {
    EXPECT_EQ(HeardOfEnd(SonarTier::kTypical, 3, off_deg).kind, Echo::kClear);
    const RangeReading heard = HeardOfEnd(SonarTier::kIdeal, 3, off_deg);
    ASSERT_EQ(heard.kind, Echo::kEcho);
    EXPECT_NEAR(heard.range_m, 3, 1e-9);
  }
}

// Two walls that meet there, either of them 45 degrees off what the transducer looks along.
std::vector<Wall> CornerAt(Vec2 at, double open_deg) {
  const auto wall = [&](double off_deg) {
    const double bearing_rad = Radians(10 + 180 + off_deg);
    return Wall{at, at + 0.3 * Vec2{Cos(bearing_rad), Sin(bearing_rad)}};
  };
  return {wall(open_deg / 2), wall(-open_deg / 2)};
}

TEST(SonarCorners, AnInnerRightAngleAnswersFromAnyAngleAndFarAway) {
  for (const double off_deg : {0.0, 5.0, 10.0, 14.0}) {
    const RangeReading heard = HeardBy3(SonarTier::kTypical, CornerAt(Before3(4, off_deg), 90));
    ASSERT_EQ(heard.kind, Echo::kEcho) << off_deg;
    EXPECT_NEAR(heard.range_m, 4, 1e-9) << off_deg;
  }
}

TEST(SonarCorners, AnInnerAngleThatIsNotRightDoesNot) {
  EXPECT_EQ(HeardBy3(SonarTier::kTypical, CornerAt(Before3(4, 0), 110)).kind, Echo::kClear);
}

TEST(SonarCorners, TheOutsideOfACornerDiffracts) {
  // The two walls lead away from the vehicle.
  EXPECT_EQ(HeardBy3(SonarTier::kTypical, CornerAt(Before3(1, 0), 270)).kind, Echo::kEcho);
  EXPECT_EQ(HeardBy3(SonarTier::kTypical, CornerAt(Before3(4, 0), 270)).kind, Echo::kClear);
}

TEST(SonarCorners, WhatStandsBetweenHidesACorner) {
  std::vector<Wall> walls = {{Before3(1.5, 0), Before3(3, 0)}};
  ASSERT_EQ(HeardBy3(SonarTier::kTypical, walls).kind, Echo::kEcho);
  // So slanted that it returns no echo itself, and its ends lie outside the cone.
  walls.push_back({Before3(0.9, 40), Before3(2.2, -25)});
  EXPECT_EQ(HeardBy3(SonarTier::kTypical, walls).kind, Echo::kClear);
}

TEST(SonarCorners, ABoxIsHeardByItsCornerAndTheOwnIsNot) {
  OneVehicle vehicle(Faultless(SonarTier::kTypical));
  const Pose standing_on_edge = {Before3(1 + 0.5 * Sqrt(2), 0), Radians(10 + 45)};
  vehicle.scene.AddBox(standing_on_edge, {0.5, 0.5}, 1);
  vehicle.scene.Index();
  EXPECT_NEAR(vehicle.Sense(1)[3].range_m, 1, 1e-9);
  OneVehicle own(Faultless(SonarTier::kTypical));
  own.scene.AddBox(standing_on_edge, {0.5, 0.5}, 0);
  own.scene.Index();
  EXPECT_EQ(own.Sense(1)[3].kind, Echo::kClear);
}

TEST(SceneCorners, ABlockHasFourCornersOutsideAndFourInside) {
  const std::vector<Wall> walls = {
      {{0, 0}, {2, 0}}, {{2, 0}, {2, 1}}, {{2, 1}, {0, 1}}, {{0, 1}, {0, 0}}};
  const SceneCorners corners(walls);
  ASSERT_EQ(corners.Edges().size(), 4U);
  ASSERT_EQ(corners.Reflectors().size(), 4U);
  for (const SceneCorner& edge : corners.Edges()) {
    EXPECT_FALSE(edge.Answers({1, 0.5}));
    EXPECT_TRUE(edge.Answers({1, 5}) || edge.Answers({1, -5}));
  }
  for (const SceneCorner& inner : corners.Reflectors()) EXPECT_TRUE(inner.Answers({1, 0.5}));
}

TEST(SceneCorners, AWallInTwoPiecesHasNoCornerWhereTheyMeet) {
  const std::vector<Wall> walls = {{{0, 0}, {1, 0}}, {{1, 0}, {2, 0}}};
  const SceneCorners corners(walls);
  EXPECT_EQ(corners.Edges().size(), 2U);
  EXPECT_EQ(corners.Reflectors().size(), 0U);
}

TEST(SceneCorners, AWallThatEndsOnAnotherMakesTwoInnerCorners) {
  const std::vector<Wall> walls = {{{0, 0}, {4, 0}}, {{2, 0}, {2, 3}}};
  const SceneCorners corners(walls);
  EXPECT_EQ(corners.Edges().size(), 3U);
  ASSERT_EQ(corners.Reflectors().size(), 2U);
  int answering = 0;
  for (const SceneCorner& inner : corners.Reflectors()) answering += inner.Answers({1, 1});
  EXPECT_EQ(answering, 1);
}

}  // namespace
}  // namespace giveway::sim
