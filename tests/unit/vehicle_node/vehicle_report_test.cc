#include "services/vehicle_node/vehicle_report.h"

#include <gtest/gtest.h>

#include "tests/unit/vehicle_node/loop_bench.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class VehicleReportTest : public testing::Test {
 protected:
  std::optional<std::uint64_t> HeapSentAt(SteadyTime now) {
    report_.Send(vehicle_, link_, now);
    return link_.LastStatus().heap_bytes;
  }
  std::optional<std::uint64_t> heap_ = 1000;
  HandClock clock_;
  ScriptedLink link_{&clock_, {}};
  Vehicle vehicle_{DefaultOptions(), 1};
  VehicleReport report_{DefaultOptions(), [this] { return heap_; }};
};

// A status may be due each tick.
TEST_F(VehicleReportTest, AsksForTheHeapOnceASecond) {
  EXPECT_EQ(HeapSentAt(seconds(100)), 1000);
  heap_ = 2000;
  EXPECT_EQ(HeapSentAt(seconds(101) - milliseconds(1)), 1000);
  EXPECT_EQ(HeapSentAt(seconds(101)), 2000);
  EXPECT_EQ(HeapSentAt(seconds(101)), 2000);
}

TEST_F(VehicleReportTest, SendsNoHeapThatIsNotKnown) {
  heap_.reset();
  EXPECT_EQ(HeapSentAt(seconds(100)), std::nullopt);
}

}  // namespace
}  // namespace giveway::test
