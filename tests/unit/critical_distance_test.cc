// How far apart two vehicles must begin to stop: what is not sure of where they are widens it.
#include <gtest/gtest.h>

#include "services/types/math.h"
#include "services/vehicle/situation.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

// A vehicle at the origin and a standing peer 3 m north-east of it.
double CriticalWith(const PoseCovariance& apart, double gate_enter_m = 0) {
  VehicleOptions options = test::DefaultOptions();
  options.gate_enter_m = gate_enter_m;
  const RangeView ranges;
  const HeardEchoes echoes{};
  const SeenObjects objects;
  const Cones cones = ConesOf(options.profile);
  const Situation s{
      .options = options, .ranges = ranges, .echoes = echoes, .cones = cones, .objects = objects};
  PeerView view{};
  view.position_world = {3, 3};
  view.apart = apart;
  view.sigma_m = SigmaPosition(apart);
  return CriticalDistance(s, view);
}

// 0.5 m along the line of the two centres and 0.1 m across it, or the other way round.
constexpr PoseCovariance kAlong{.xx_m2 = 0.13, .xy_m2 = 0.12, .yy_m2 = 0.13};
constexpr PoseCovariance kAcross{.xx_m2 = 0.13, .xy_m2 = -0.12, .yy_m2 = 0.13};

TEST(CriticalDistance, IsWidenedByTwiceWhatIsUnsureAlongTheLineBetweenThem) {
  const double sure = CriticalWith({});
  EXPECT_NEAR(CriticalWith(kAlong), sure + 2 * 0.5, 1e-12);
  EXPECT_NEAR(CriticalWith(kAcross), sure + 2 * 0.1, 1e-12);
}

TEST(CriticalDistance, IsNeverBelowTheGate) {
  EXPECT_EQ(CriticalWith(kAcross, 1.5), 1.5);
  EXPECT_GT(CriticalWith({.xx_m2 = 1, .yy_m2 = 1}, 1.5), 1.5);
}

// Who drives on a heading it is not sure of is less sure of its place the farther it comes.
TEST(CriticalDistance, IsTakenFromACovarianceThatTheBeaconTells) {
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
