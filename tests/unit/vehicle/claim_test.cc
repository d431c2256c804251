// The region a peer can reach before it stands: no manoeuvre of a peer leads out of its claim, and
// no vehicle drives into one.
#include "services/vehicle/situation/claim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  const Twist twist = TwistFromWheels(beacon.drive, beacon.wheels);
  return giveway::ClaimOf(beacon,
                          {Forward(beacon.world_from_body), twist.forward_m_s, twist.turn_rad_s},
                          unknown_s, kReaction_s);
}

bool Holds(const Claim& claim, Vec2 point) {
  const double along = Dot(point - claim.axis.from_world, claim.axis.direction_world);
  const double at = along < 0 ? 0 : (along > claim.length_m ? claim.length_m : along);
  return Norm(point - claim.axis.from_world - at * claim.axis.direction_world) <= claim.radius_m;
}

// A vehicle by its rims, each of which speeds up and brakes as its drive allows, whatever is
// commanded.
struct Rims {
  double left_m_s;
  double right_m_s;

  bool Stand() const { return left_m_s == 0 && right_m_s == 0; }
  Twist Moves(const Beacon& beacon) const {
    return {(left_m_s + right_m_s) / 2, (right_m_s - left_m_s) / beacon.drive.axle_m};
  }
  void Chase(const Twist& wanted, const Beacon& beacon, double step_s) {
    const double beside_m_s = wanted.turn_rad_s * beacon.drive.axle_m / 2;
    Chase(wanted.forward_m_s - beside_m_s, beacon, step_s, &left_m_s);
    Chase(wanted.forward_m_s + beside_m_s, beacon, step_s, &right_m_s);
    // As steering.cc promises: the faster rim does not outrun the other.
    const double most_m_s = kTurnWhileDriving_rad_s * beacon.drive.axle_m;
    left_m_s = std::min(left_m_s, right_m_s + most_m_s);
    right_m_s = std::min(right_m_s, left_m_s + most_m_s);
  }

 private:
  static void Chase(double wanted, const Beacon& beacon, double step_s, double* rim) {
    const bool brakes = std::abs(wanted) < std::abs(*rim) || wanted * *rim < 0;
    const double most = (brakes ? beacon.deceleration_m_s2 : beacon.acceleration_m_s2) * step_s;
    *rim += std::clamp(wanted - *rim, -most, most);
  }
};

Beacon AnyBeacon(Random* random) {
  const double cruise = random->Uniform(0.1, 1.0);
  Beacon beacon = Driving(0, cruise, random->Uniform(-3, 3));
  beacon.drive.axle_m = random->Uniform(0.2, 0.6);
  beacon.acceleration_m_s2 = random->Uniform(0.1, 2.0);
  beacon.deceleration_m_s2 = random->Uniform(0.15, 2.0);
  const bool creeps = random->Uniform(0, 1) < 0.2;
  beacon.wheels = WheelsFromTwist(
      beacon.drive, {random->Uniform(creeps ? -0.3 : 0, creeps ? 0.03 : cruise),
                     random->Uniform(-kTurnWhileDriving_rad_s, kTurnWhileDriving_rad_s)});
  const double off_rad = random->Uniform(0, 0.1);  // one standard deviation of the heading
  beacon.covariance.hh_rad2 = off_rad * off_rad;
  return beacon;
}

// Drives anyhow for unknown_s, keeps that up for its reaction time, then brakes both rims, from a
// heading that is off by as much as is allowed for. Every profile that the checks allow, turning
// included: 865cb28 assumed one turn rate for all profiles, and no turning while braking; later one
// that turned on the spot, or stopped reversing and set off, came 0.1 m further than it claimed.
TEST(Claim, HoldsWhateverThePeerDoesBeforeItStands) {
  constexpr double kStep_s = 0.01;
  constexpr int kReactionSteps = 10;  // kReaction_s
  for (std::uint32_t number = 1; number <= 50000; ++number) {
    Random random(number);
    const Beacon beacon = AnyBeacon(&random);
    const int unknown_steps = static_cast<int>(random.Uniform(5, 101));  // as long as a claim lasts
    const double unknown_s = unknown_steps * kStep_s;
    Claim centre = ClaimOf(beacon, unknown_s);
    // The claim holds the whole body: its centre stays a body's radius inside. In a million draws
    // the worst leaves it by 7.9 mm, and every vehicle keeps kClearance_m, 50 mm, from it.
    centre.radius_m -= beacon.body_radius_m - 10e-3;
    const Twist stated = TwistFromWheels(beacon.drive, beacon.wheels);
    const double beside_m_s = stated.turn_rad_s * beacon.drive.axle_m / 2;
    Rims rims{stated.forward_m_s - beside_m_s, stated.forward_m_s + beside_m_s};
    const Twist wanted{random.Uniform(0, beacon.cruise_m_s),
                       random.Uniform(-kTurnWhileDriving_rad_s, kTurnWhileDriving_rad_s)};
    const double most_rad = kSigmas * SigmaHeading(beacon.covariance);
    Pose pose = beacon.world_from_body;
    pose.heading_rad += random.Uniform(-most_rad, most_rad);
    for (int step = 0; step < unknown_steps + kReactionSteps || !rims.Stand(); ++step) {
      if (step < unknown_steps) rims.Chase(wanted, beacon, kStep_s);
      if (step >= unknown_steps + kReactionSteps) rims.Chase(Twist{}, beacon, kStep_s);
      pose = AdvanceArc(pose, rims.Moves(beacon), kStep_s);
      ASSERT_TRUE(Holds(centre, pose.position_world))
          << "case " << number << " at step " << step << " of " << stated.forward_m_s << " m/s, "
          << stated.turn_rad_s << " rad/s, brakes " << beacon.deceleration_m_s2 << ", speeds up "
          << beacon.acceleration_m_s2 << ", unknown " << unknown_s << " s";
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

// Regression: head-on within the long claim of a peer with weak brakes, the path to its body led
// along the axis and no deeper, was taken for an exit, and both touched.
TEST(FreeBefore, FromInsideTheWayToTheBodyIsNotFree) {
  const Claim claim{.axis = {{0, 0}, {1, 0}}, .length_m = 2, .radius_m = 0.25};
  EXPECT_EQ(FreeBefore(claim, {{1.5, 0}, {-1, 0}}, 0.25), 0);
  EXPECT_EQ(FreeBefore(claim, {{1.5, 0.1}, {-1, 0}}, 0.25), 0);
  EXPECT_GT(FreeBefore(claim, {{1.5, 0.1}, {1, 0}}, 0.25), 1000) << "as it drives itself";
}

TEST(FreeBefore, FromInsideOnlyTheWayOutIsFree) {
  const Claim claim{.axis = {{0, 0}, {1, 0}}, .length_m = 2, .radius_m = 0.25};
  EXPECT_EQ(FreeBefore(claim, {{1, 0.4}, {0, -1}}, 0.25), 0);
  EXPECT_GT(FreeBefore(claim, {{1, 0.4}, {0, 1}}, 0.25), 1000);
}

}  // namespace
}  // namespace giveway
