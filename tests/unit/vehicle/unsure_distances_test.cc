// The uncertainty of where two vehicles are widens the distances that they keep.
#include <gtest/gtest.h>

#include <optional>

#include "services/types/math/math.h"
#include "tests/support/onlooker.h"

namespace giveway {
namespace {

VehicleOptions WithGate(double gate_enter_m) {
  VehicleOptions options = test::DefaultOptions();
  options.gate_enter_m = gate_enter_m;
  return options;
}

// To a standing peer 3 m east and 3 m north of it.
double CriticalDistanceWith(const PoseCovariance& covariance, double gate_enter_m = 0) {
  const test::Onlooker onlooker(WithGate(gate_enter_m));
  Peer peer = test::PeerAt({{3, 3}, 0}, covariance);
  return CriticalDistance(onlooker.Own(), onlooker.RelatePeer(&peer));
}

// Of a peer that comes from the right.
std::optional<Conflict> CrossingWith(const PoseCovariance& covariance) {
  Peer peer = test::PeerAt({{4, -3}, kPi / 2}, covariance);
  return test::Onlooker().RelatePeer(&peer).crossing;
}

// Before the claim of a peer straight ahead.
double FreeWith(const PoseCovariance& covariance) {
  Peer peer = test::PeerAt({{6, 0}, 0}, covariance);
  return test::Onlooker().RelatePeer(&peer).free_m;
}

bool MattersBeside(const PoseCovariance& covariance) {
  const Peer peer = test::PeerAt({{30, -3}, 0}, covariance);
  return IsRelevant(peer, true, test::Onlooker().Own());
}

// Whether an echo straight ahead, so much nearer than the body of a peer 1.5 m ahead, is its own.
bool TakesForItsOwn(double nearer_m, const PoseCovariance& covariance) {
  test::Onlooker onlooker;
  Peer peer = test::PeerAt({{1.5, 0}, kPi}, covariance);
  const std::size_t ahead = 3;  // the sensor that looks most nearly ahead
  const Vec2 mount = test::DefaultOptions().profile.sonar[ahead].position_body;
  onlooker.Hear(ahead, Norm(Vec2{1.5, 0} - mount) - peer.beacon.body_radius_m - nearer_m);
  return onlooker.RelatePeer(&peer).explains != 0;
}

// 0.5 m along the line of the two centres and 0.1 m across it, or vice versa.
constexpr PoseCovariance kAlong{.xx_m2 = 0.13, .xy_m2 = 0.12, .yy_m2 = 0.13};
constexpr PoseCovariance kAcross{.xx_m2 = 0.13, .xy_m2 = -0.12, .yy_m2 = 0.13};

TEST(CriticalDistance, IsWidenedByTwiceWhatIsUnsureAlongTheLineBetweenThem) {
  const double sure = CriticalDistanceWith({});
  EXPECT_NEAR(CriticalDistanceWith(kAlong), sure + 2 * 0.5, 1e-12);
  EXPECT_NEAR(CriticalDistanceWith(kAcross), sure + 2 * 0.1, 1e-12);
}

TEST(CriticalDistance, IsNeverBelowTheGate) {
  EXPECT_EQ(CriticalDistanceWith(kAcross, 1.5), 1.5);
  EXPECT_GT(CriticalDistanceWith({.xx_m2 = 1, .yy_m2 = 1}, 1.5), 1.5);
}

// The direction of the worst axis makes no difference to paths and claims: they lead anywhere.
TEST(Ways, AreKeptApartByTwiceWhatIsUnsureAlongTheWorstAxis) {
  const auto sure = CrossingWith({});
  ASSERT_TRUE(sure);
  for (const PoseCovariance& covariance : {kAlong, kAcross}) {
    const auto unsure = CrossingWith(covariance);
    ASSERT_TRUE(unsure);
    EXPECT_NEAR(unsure->own.begin_m, sure->own.begin_m - 2 * 0.5, 1e-9);
    EXPECT_NEAR(unsure->own.end_m, sure->own.end_m + 2 * 0.5, 1e-9);
  }
}

TEST(Claims, AreKeptFromByTwiceWhatIsUnsureAlongTheWorstAxis) {
  EXPECT_NEAR(FreeWith(kAcross), FreeWith({}) - 2 * 0.5, 1e-9);
}

// From shared_goal 1000 of mixed fleets, whose poses were off by three deviations: echoes showed a
// peer 0.17 m nearer than its beacon, were taken for its own and so for no obstacle, and its claim
// was kept from as far as before.
TEST(Claims, AreKeptFromByWhatItsEchoesShowThePeerToBeNearer) {
  constexpr PoseCovariance kUnsure{.xx_m2 = 0.01, .yy_m2 = 0.01};
  const auto free_m = [&](double nearer_m) {
    test::Onlooker onlooker;
    Peer peer = test::PeerAt({{1.5, 0}, kPi}, kUnsure);
    const std::size_t ahead = 3;
    const Vec2 mount = test::DefaultOptions().profile.sonar[ahead].position_body;
    onlooker.Hear(ahead, Norm(Vec2{1.5, 0} - mount) - peer.beacon.body_radius_m - nearer_m);
    return onlooker.RelatePeer(&peer).free_m;
  };
  EXPECT_EQ(free_m(0), free_m(0.19)) << "two deviations are kept anyway";
  EXPECT_NEAR(free_m(0.25), free_m(0) - 0.05, 0.005);
}

// A metre a second along a heading that is unsure by 0.1 rad, for the one tick since its beacon.
TEST(Peers, AreLessSureTheFartherTheyWereCarriedOn) {
  const WheelSpeeds one_m_s = {1 / 0.0975, 1 / 0.0975};
  Peer peer = test::PeerAt({{4, -3}, kPi / 2}, {.hh_rad2 = 0.01}, one_m_s);
  const PeerView view = test::Onlooker().RelatePeer(&peer);
  EXPECT_NEAR(view.sigma_m, 0.05 * 0.1, 1e-12);
  EXPECT_NEAR(view.apart.xx_m2, 0.005 * 0.005, 1e-12);
  EXPECT_NEAR(view.apart.yy_m2, 0, 1e-12);
}

// An uncertain peer counts as relevant at a greater distance.
TEST(Peers, ThatAreUnsureMatterFromFartherAway) {
  EXPECT_FALSE(MattersBeside({}));
  EXPECT_TRUE(MattersBeside({.xx_m2 = 4, .yy_m2 = 4}));
}

TEST(Echoes, OfAPeerMayBeNearerByTwiceWhatIsUnsure) {
  EXPECT_TRUE(TakesForItsOwn(0, {}));
  EXPECT_FALSE(TakesForItsOwn(0.15, {}));
  EXPECT_TRUE(TakesForItsOwn(0.15, {.xx_m2 = 0.01, .yy_m2 = 0.01}));
}

// On an uncertain heading the uncertainty of the position grows with the distance driven.
TEST(Beacon, TellsTheCovarianceOfItsPose) {
  VehicleOptions options = test::DefaultOptions();
  options.profile.wheel_slip = 0.05;
  test::BrainBench bench(options);
  RangeScan scan = test::ClearScan(0);
  scan.wheels = {3, 3};
  Outputs out;
  for (int i = 0; i < 200; ++i) out = bench.Step(scan);
  const PoseCovariance& published = out.beacon.covariance;
  EXPECT_EQ(published, bench.Brain().State().motion.odometry.Covariance());
  EXPECT_GT(published.xx_m2, 0);
  EXPECT_GT(published.yy_m2, 10 * published.xx_m2);
  EXPECT_GT(published.yh_m_rad, 0);
}

}  // namespace
}  // namespace giveway
