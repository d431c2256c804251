// Where a peer can be until it stands: nothing a peer may do leads out of its claim, and nobody
// drives into one.
#include "services/vehicle/situation/claim.h"

#include <gtest/gtest.h>

#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway {
namespace {

constexpr double kReaction_s = 0.1;

Beacon Driving(double speed_m_s, double cruise_m_s, double heading_rad) {
  Beacon beacon;
  beacon.vehicle = VehicleId{2};
  beacon.cruise_m_s = cruise_m_s;
  beacon.wheels = WheelsFromTwist(beacon.drive, {speed_m_s, 0});
  beacon.world_from_body = {{1, 2}, heading_rad};
  return beacon;
}

Claim ClaimOf(const Beacon& beacon, double unknown_s) {
  const double speed_m_s = TwistFromWheels(beacon.drive, beacon.wheels).forward_m_s;
  return giveway::ClaimOf(beacon, {Forward(beacon.world_from_body), speed_m_s}, unknown_s,
                          kReaction_s);
}

bool Holds(const Claim& claim, Vec2 point) {
  const double along = Dot(point - claim.axis.from_world, claim.axis.direction_world);
  const double at = along < 0 ? 0 : (along > claim.length_m ? claim.length_m : along);
  return Norm(point - claim.axis.from_world - at * claim.axis.direction_world) <= claim.radius_m;
}

// Speeds up, turns and brakes as it likes for unknown_s, then brakes after its reaction time.
TEST(Claim, HoldsWhateverThePeerDoesBeforeItBrakes) {
  constexpr double kStep_s = 0.005;
  for (std::uint32_t number = 1; number <= 2000; ++number) {
    Random random(number);
    const double cruise = random.Uniform(0.1, 1.0);
    const Beacon beacon = Driving(random.Uniform(0, cruise), cruise, random.Uniform(-3, 3));
    const double unknown_s = random.Uniform(0.05, 0.4);
    const Claim claim = ClaimOf(beacon, unknown_s);
    Pose pose = beacon.world_from_body;
    double speed = TwistFromWheels(beacon.drive, beacon.wheels).forward_m_s;
    const double turn = random.Uniform(-0.87, 0.87);
    const double push = random.Uniform(-0.6, 0.3);
    for (double t = 0; t < unknown_s + kReaction_s || speed > 0; t += kStep_s) {
      if (t < unknown_s) {
        speed = std::min(cruise, std::max(0.0, speed + push * kStep_s));
      } else if (t >= unknown_s + kReaction_s) {
        speed = std::max(0.0, speed - beacon.deceleration_m_s2 * kStep_s);
      }
      pose = AdvanceArc(pose, {speed, t < unknown_s ? turn : 0}, kStep_s);
      // The claim holds the whole body: its centre stays a body's radius inside.
      Claim centre = claim;
      centre.radius_m -= beacon.body_radius_m - 1e-3;
      ASSERT_TRUE(Holds(centre, pose.position_world)) << "case " << number << " at " << t << " s";
    }
  }
}

TEST(Claim, GrowsWithWhatIsNotKnown) {
  const Beacon beacon = Driving(0.3, 0.4, 0);
  EXPECT_LT(ClaimOf(beacon, 0.1).length_m, ClaimOf(beacon, 0.3).length_m);
  EXPECT_LT(ClaimOf(beacon, 0.1).radius_m, ClaimOf(beacon, 0.3).radius_m);
}

TEST(Claim, OfOneThatStandsIsLittleMoreThanItsBody) {
  const Claim claim = ClaimOf(Driving(0, 1.0, 0), 0.1);
  EXPECT_LT(claim.length_m + claim.radius_m, 0.27);
}

TEST(Claim, LiesBehindOneThatReverses) {
  const Claim claim = ClaimOf(Driving(-0.3, 0.4, 0), 0.1);
  EXPECT_LT(claim.axis.direction_world.x, 0);
}

TEST(FreeBefore, IsWhereTheDiscFirstTouches) {
  const Claim claim{.axis = {{0, 0}, {1, 0}}, .length_m = 2, .radius_m = 0.25};
  EXPECT_NEAR(FreeBefore(claim, {{-3, 0}, {1, 0}}, 0.25), 2.5, 1e-12);
  EXPECT_NEAR(FreeBefore(claim, {{1, -3}, {0, 1}}, 0.25), 2.5, 1e-12);
  EXPECT_NEAR(FreeBefore(claim, {{5, 0}, {-1, 0}}, 0.25), 2.5, 1e-12);
}

TEST(FreeBefore, IsHugeWhereTheyPass) {
  const Claim claim{.axis = {{0, 0}, {1, 0}}, .length_m = 2, .radius_m = 0.25};
  EXPECT_GT(FreeBefore(claim, {{-3, 0.51}, {1, 0}}, 0.25), 1000);
  EXPECT_GT(FreeBefore(claim, {{3, 0}, {1, 0}}, 0.25), 1000);
  EXPECT_GT(FreeBefore(claim, {{2.6, -3}, {0, 1}}, 0.25), 1000);
}

TEST(FreeBefore, FromInsideOnlyTheWayOutIsFree) {
  const Claim claim{.axis = {{0, 0}, {1, 0}}, .length_m = 2, .radius_m = 0.25};
  EXPECT_EQ(FreeBefore(claim, {{1, 0.4}, {0, -1}}, 0.25), 0);
  EXPECT_GT(FreeBefore(claim, {{1, 0.4}, {0, 1}}, 0.25), 1000);
}

}  // namespace
}  // namespace giveway
