// What a vehicle's loop logs about its peers, and how much of it.
#include "services/vehicle_node/vehicle_log.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "services/runtime/process.h"

namespace giveway {
namespace {

// Regression: a participant with any number of writers of beacons had a line logged for each.
TEST(VehicleLog, LeavesOutWhatAFloodOfWritersSaysAndSaysHowMuch) {
  constexpr std::ptrdiff_t kLines = 256;
  ::testing::internal::CaptureStderr();
  InitLog("vehicle", "text", "info");
  VehicleOptions options;
  options.id = VehicleId{1};
  const Vehicle vehicle(options, 1);
  VehicleLog log;
  log.LogEvents(std::vector<QosEvent>(5000), vehicle, std::chrono::seconds(10));
  log.LogEvents({}, vehicle, std::chrono::seconds(11));
  EXPECT_TRUE(FlushLog(std::chrono::seconds(10)));
  const std::string lines = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::ranges::count(lines, '\n'), kLines + 1);
  EXPECT_THAT(lines, ::testing::HasSubstr("and 4744 more such events"));
}

}  // namespace
}  // namespace giveway
