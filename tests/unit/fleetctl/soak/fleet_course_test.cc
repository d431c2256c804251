#include "services/fleetctl/soak/fleet_course.h"

#include <gtest/gtest.h>

#include <chrono>

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr VehicleId kHealed{1};

bool Never(VehicleId) { return false; }

void Report(SoakWatch* watch, SteadyTime now) {
  link::Observed observed;
  VehicleStatus& status = observed.statuses.emplace_back();
  status.vehicle = kHealed;
  status.decision = {Mode::kCooperative, Rule::kCruise};
  status.forward_m_s = 0.3;
  watch->Fold(observed, now);
}

TEST(FleetCourse, TakesForHealedOnlyWhoReportsAfterTheLastFaultThatItDrives) {
  SoakWatch watch({kHealed}, {});
  FleetCourse course({kHealed}, Never, Never);
  SoakSeen seen;
  Report(&watch, milliseconds(9900));
  course.SeekHealing(watch, seconds(10), &seen);
  EXPECT_FALSE(seen.healing.at(kHealed)) << "said before";
  Report(&watch, milliseconds(10400));
  course.SeekHealing(watch, milliseconds(10500), &seen);
  ASSERT_TRUE(seen.healing.at(kHealed));
  EXPECT_DOUBLE_EQ(*seen.healing.at(kHealed), 0.5);
}

// A kill was the last fault, and the process had not ended when healing started.
TEST(FleetCourse, ExpectsNothingOfOneThatIsGone) {
  bool gone = false;
  SoakWatch watch({kHealed}, {});
  FleetCourse course({kHealed}, Never, [&](VehicleId) { return gone; });
  SoakSeen seen;
  course.SeekHealing(watch, seconds(10), &seen);
  gone = true;
  course.SeekHealing(watch, seconds(20), &seen);
  EXPECT_TRUE(seen.healing.empty());
  EXPECT_TRUE(seen.silent_s.empty());
}

TEST(FleetCourse, KnowsForHowLongNothingWasReportedAfterTheLastFault) {
  SoakWatch watch({kHealed}, {});
  FleetCourse course({kHealed}, Never, Never);
  SoakSeen seen;
  course.SeekHealing(watch, seconds(10), &seen);
  Report(&watch, seconds(11));
  course.SeekHealing(watch, seconds(11), &seen);
  course.SeekHealing(watch, seconds(18), &seen);
  Report(&watch, seconds(19));
  course.SeekHealing(watch, seconds(20), &seen);
  EXPECT_DOUBLE_EQ(seen.silent_s.at(kHealed), 7);
}

}  // namespace
}  // namespace giveway::fleetctl
