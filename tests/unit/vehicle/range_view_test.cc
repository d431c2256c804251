#include "services/vehicle/estimation/range_view.h"

#include <gtest/gtest.h>

#include "services/vehicle/estimation/cones.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using test::ClearScan;

class RangeViewTest : public testing::Test {
 protected:
  void Take(std::uint32_t tick, double range_m) {
    RangeScan scan = ClearScan(tick);
    test::SetEcho(&scan, 3, range_m);
    view_.Take(scan, milliseconds(tick * 50), options_.tick_period);
  }

  VehicleOptions options_ = test::DefaultOptions();
  std::uint32_t enabled_ = ConesOf(options_.profile).enabled;
  RangeView view_;
};

TEST_F(RangeViewTest, NoEchoIsNotNoData) {
  RangeScan scan = ClearScan(1);
  view_.Take(scan, milliseconds(50), options_.tick_period);
  EXPECT_EQ(view_[3].kind, Echo::kClear);
  EXPECT_EQ(view_.FirstBlind(milliseconds(50), Tick{1}, options_, enabled_), -1);
  scan = ClearScan(2);
  scan.readings[3] = {Echo::kNoData, 0, Tick{2}};
  view_.Take(scan, milliseconds(100), options_.tick_period);
  EXPECT_EQ(view_.FirstBlind(milliseconds(100), Tick{2}, options_, enabled_), 3);
}

TEST_F(RangeViewTest, SwitchedOffSensorsDoNotBlind) {
  view_.Take(ClearScan(1), milliseconds(50), options_.tick_period);  // rear eight have no data
  EXPECT_EQ(view_.FirstBlind(milliseconds(50), Tick{1}, options_, enabled_), -1);
}

TEST_F(RangeViewTest, AScanTooOldIsNoScan) {
  EXPECT_EQ(view_.FirstBlind(milliseconds(0), Tick{1}, options_, enabled_),
            static_cast<int>(kSensorCount));
  view_.Take(ClearScan(1), milliseconds(50), options_.tick_period);
  EXPECT_EQ(view_.FirstBlind(milliseconds(200), Tick{1}, options_, enabled_), -1);
  EXPECT_EQ(view_.FirstBlind(milliseconds(201), Tick{1}, options_, enabled_),
            static_cast<int>(kSensorCount));
}

TEST_F(RangeViewTest, ASensorThatNoLongerFiresIsBlindByItself) {
  RangeScan scan = ClearScan(5);
  scan.readings[6].tick = Tick{1};
  view_.Take(scan, milliseconds(250), options_.tick_period);
  EXPECT_EQ(view_.FirstBlind(milliseconds(250), Tick{5}, options_, enabled_), 6);
  EXPECT_EQ(view_.FirstBlind(milliseconds(250), Tick{4}, options_, enabled_), -1);  // 150 ms old
}

TEST_F(RangeViewTest, WhoFiredForATickSpeaksForNoOther) {
  EXPECT_EQ(view_.SpokeAt(kNoTick), 0U);
  RangeScan scan = ClearScan(5);
  scan.readings[1] = {Echo::kEcho, 0.5, Tick{5}};
  scan.readings[6].tick = Tick{4};
  view_.Take(scan, milliseconds(250), options_.tick_period);
  EXPECT_EQ(view_.SpokeAt(Tick{5}), 0b1011'1111U);  // the rear eight have no data
  EXPECT_EQ(view_.SpokeAt(Tick{4}), 0U);
  EXPECT_EQ(view_.SpokeAt(Tick{6}), 0U);
}

TEST_F(RangeViewTest, ClosingSpeedIsTheRateOfTheRange) {
  for (std::uint32_t tick = 1; tick <= 10; ++tick) Take(tick, 2.0 - 0.02 * tick);
  EXPECT_NEAR(view_[3].closing_m_s, 0.4, 1e-9);
  EXPECT_EQ(view_[3].streak, 9U);
}

// With a firing schedule most scans repeat a sensor's last reading.
TEST_F(RangeViewTest, ARepeatedReadingIsNotANewOne) {
  for (std::uint32_t tick = 1; tick <= 3; ++tick) Take(tick, 2.0 - 0.02 * tick);
  RangeScan scan = ClearScan(4);
  scan.readings[3] = {Echo::kEcho, 1.94, Tick{3}};
  view_.Take(scan, milliseconds(200), options_.tick_period);
  EXPECT_EQ(view_[3].streak, 2U);
  EXPECT_NEAR(view_[3].closing_m_s, 0.4, 1e-9);
}

TEST_F(RangeViewTest, AJumpIsAnotherObject) {
  Take(1, 3.0);
  Take(2, 2.99);
  Take(3, 0.8);
  EXPECT_EQ(view_[3].streak, 0U);
  EXPECT_EQ(view_[3].closing_m_s, 0);
}

TEST_F(RangeViewTest, TheNearestEchoIsOverAllSensors) {
  EXPECT_LT(view_.NearestEcho(), 0);
  RangeScan scan = ClearScan(1);
  test::SetEcho(&scan, 1, 2.0);
  test::SetEcho(&scan, 6, 0.7);
  view_.Take(scan, milliseconds(50), options_.tick_period);
  EXPECT_EQ(view_.NearestEcho(), 0.7);
}

}  // namespace
}  // namespace giveway
