// What is not sure of where two vehicles are widens the distances that they keep.
#include <gtest/gtest.h>

#include <optional>

#include "services/types/math.h"
#include "services/vehicle/echoes.h"
#include "services/vehicle/look.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

// A vehicle at the origin that looks east, and what it makes of a peer.
class Onlooker {
 public:
  explicit Onlooker(double gate_enter_m = 0) {
    options_.gate_enter_m = gate_enter_m;
    situation_.emplace(Situation{.options = options_,
                                 .ranges = ranges_,
                                 .echoes = echoes_,
                                 .cones = cones_,
                                 .objects = objects_});
    situation_->tick = Tick{2};
    situation_->forward_world = {1, 0};
    situation_->path = {{0, 0}, {1, 0}};
    situation_->distance_to_goal_m = 100;
    situation_->slows_m = 10;
  }

  // To a standing peer 3 m east and 3 m north of it.
  double CriticalDistanceWith(const PoseCovariance& apart) const {
    Peer peer{.id = VehicleId{2}};
    PeerView view{.peer = &peer};
    view.position_world = {3, 3};
    view.apart = apart;
    view.sigma_m = SigmaPosition(apart);
    return CriticalDistance(*situation_, view);
  }
  PeerView At(const Pose& pose, const PoseCovariance& covariance, WheelSpeeds wheels = {}) {
    peer_ = Peer{.id = VehicleId{2}, .known = true};
    peer_.beacon = test::BeaconOf(2, 1, pose);
    peer_.beacon.covariance = covariance;
    peer_.beacon.wheels = wheels;
    PeerView view{.peer = &peer_, .fresh = true};
    CarryForward({&view, 1}, *situation_);
    LookAt(&view, *situation_);
    return view;
  }
  bool CanMatter(const Pose& pose, const PoseCovariance& covariance) {
    At(pose, covariance);
    return giveway::CanMatter(peer_, true, *situation_);
  }
  // Whether an echo straight ahead, so much nearer than the body of a peer 1.5 m ahead, is its own.
  bool TakesForItsOwn(double nearer_m, const PoseCovariance& covariance) {
    const PeerView view = At({{1.5, 0}, kPi}, covariance);
    const std::size_t ahead = 3;  // the sensor that looks most nearly ahead
    const Vec2 mount = options_.profile.sonar[ahead].position_body;
    RangeScan scan = test::ClearScan(2);
    test::SetEcho(&scan, 3, Norm(Vec2{1.5, 0} - mount) - peer_.beacon.body_radius_m - nearer_m);
    ranges_.Take(scan, SteadyTime{0}, options_.tick_period);
    HearEchoes(ranges_, situation_->tick, options_, &echoes_);
    return EchoesOf(view, *situation_) != 0;
  }

 private:
  VehicleOptions options_ = test::DefaultOptions();
  RangeView ranges_;
  HeardEchoes echoes_{};
  SeenObjects objects_;
  Cones cones_ = ConesOf(options_.profile);
  std::optional<Situation> situation_;
  Peer peer_;
};

// 0.5 m along the line of the two centres and 0.1 m across it, or the other way round.
constexpr PoseCovariance kAlong{.xx_m2 = 0.13, .xy_m2 = 0.12, .yy_m2 = 0.13};
constexpr PoseCovariance kAcross{.xx_m2 = 0.13, .xy_m2 = -0.12, .yy_m2 = 0.13};

TEST(CriticalDistance, IsWidenedByTwiceWhatIsUnsureAlongTheLineBetweenThem) {
  const Onlooker onlooker;
  const double sure = onlooker.CriticalDistanceWith({});
  EXPECT_NEAR(onlooker.CriticalDistanceWith(kAlong), sure + 2 * 0.5, 1e-12);
  EXPECT_NEAR(onlooker.CriticalDistanceWith(kAcross), sure + 2 * 0.1, 1e-12);
}

TEST(CriticalDistance, IsNeverBelowTheGate) {
  const Onlooker onlooker(1.5);
  EXPECT_EQ(onlooker.CriticalDistanceWith(kAcross), 1.5);
  EXPECT_GT(onlooker.CriticalDistanceWith({.xx_m2 = 1, .yy_m2 = 1}), 1.5);
}

// Which way the worst axis lies makes no difference to ways and claims: they lead anywhere.
TEST(Ways, AreKeptApartByTwiceWhatIsUnsureAlongTheWorstAxis) {
  Onlooker onlooker;
  const Pose south_of_the_way{{4, -3}, kPi / 2};
  const auto sure = onlooker.At(south_of_the_way, {}).crossing;
  ASSERT_TRUE(sure);
  for (const PoseCovariance& covariance : {kAlong, kAcross}) {
    const auto unsure = onlooker.At(south_of_the_way, covariance).crossing;
    ASSERT_TRUE(unsure);
    EXPECT_NEAR(unsure->own.begin_m, sure->own.begin_m - 2 * 0.5, 1e-9);
    EXPECT_NEAR(unsure->own.end_m, sure->own.end_m + 2 * 0.5, 1e-9);
  }
}

TEST(Claims, AreKeptFromByTwiceWhatIsUnsureAlongTheWorstAxis) {
  Onlooker onlooker;
  const Pose ahead{{6, 0}, 0};
  const double sure_m = onlooker.At(ahead, {}).free_m;
  EXPECT_NEAR(onlooker.At(ahead, kAcross).free_m, sure_m - 2 * 0.5, 1e-9);
}

// A metre a second along a heading that is unsure by 0.1 rad, for the one tick since its beacon.
TEST(Peers, AreLessSureTheFartherTheyWereCarriedOn) {
  Onlooker onlooker;
  const WheelSpeeds one_m_s = {1 / 0.0975, 1 / 0.0975};
  const PeerView view = onlooker.At({{4, -3}, kPi / 2}, {.hh_rad2 = 0.01}, one_m_s);
  EXPECT_NEAR(view.sigma_m, 0.05 * 0.1, 1e-12);
  EXPECT_NEAR(view.apart.xx_m2, 0.005 * 0.005, 1e-12);
  EXPECT_NEAR(view.apart.yy_m2, 0, 1e-12);
}

// What is too far away to matter stays so only as far as it is known where it is.
TEST(Peers, ThatAreUnsureMatterFromFartherAway) {
  Onlooker onlooker;
  const Pose beside{{30, -3}, 0};
  EXPECT_FALSE(onlooker.CanMatter(beside, {}));
  EXPECT_TRUE(onlooker.CanMatter(beside, {.xx_m2 = 4, .yy_m2 = 4}));
}

TEST(Echoes, OfAPeerMayBeNearerByTwiceWhatIsUnsure) {
  EXPECT_TRUE(Onlooker().TakesForItsOwn(0, {}));
  EXPECT_FALSE(Onlooker().TakesForItsOwn(0.15, {}));
  EXPECT_TRUE(Onlooker().TakesForItsOwn(0.15, {.xx_m2 = 0.01, .yy_m2 = 0.01}));
}

// Who drives on a heading it is not sure of is less sure of its place the farther it comes.
TEST(Beacon, TellsTheCovarianceOfItsPose) {
  VehicleOptions options = test::DefaultOptions();
  options.profile.wheel_slip = 0.05;
  test::BrainBench bench(options);
  RangeScan scan = test::ClearScan(0);
  scan.wheels = {3, 3};
  Outputs out;
  for (int i = 0; i < 200; ++i) out = bench.Step(scan);
  const PoseCovariance& told = out.beacon.covariance;
  EXPECT_EQ(told, bench.Brain().State().odometry.Covariance());
  EXPECT_GT(told.xx_m2, 0);
  EXPECT_GT(told.yy_m2, 10 * told.xx_m2);
  EXPECT_GT(told.yh_m_rad, 0);
}

}  // namespace
}  // namespace giveway
