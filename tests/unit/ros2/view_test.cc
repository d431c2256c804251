// Which messages are due when: the rate, what is new, vehicles that join and leave.
#include "services/ros2/view.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace giveway::ros2 {
namespace {

constexpr std::uint64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::uint64_t kMs = 1'000'000;

View MakeView(double rate_hz = 10) {
  return View(rate_hz, [](VehicleId) { return PioneerP3dx(); });
}

Times At(std::uint64_t ms) { return {kStart_ns + ms * kMs, kStart_ns + ms * kMs}; }

Beacon BeaconAt(VehicleId vehicle, double x_m) {
  Beacon beacon;
  beacon.vehicle = vehicle;
  beacon.world_from_body.position_world.x = x_m;
  return beacon;
}

std::size_t Count(const Batch& batch, const std::string& topic) {
  std::size_t count = 0;
  for (const Message& message : batch.messages) count += message.topic == topic ? 1 : 0;
  return count;
}

template <typename Kind>
const Kind& Only(const Batch& batch, const std::string& topic) {
  for (const Message& message : batch.messages) {
    if (message.topic == topic) return std::get<Kind>(message.body);
  }
  ADD_FAILURE() << "nothing on " << topic;
  static const Kind kNone;
  return kNone;
}

Batch CollectAt(View& view, std::uint64_t ms) { return view.Collect(kStart_ns + ms * kMs); }

TEST(View, GivesTheNewestOfAVehicleTenTimesASecond) {
  View view = MakeView();
  std::size_t messages = 0;
  double last_x_m = 0;
  for (std::uint64_t ms = 0; ms < 2000; ms += 20) {
    view.Take(BeaconAt(VehicleId{3}, static_cast<double>(ms)), At(ms));
    const Batch batch = CollectAt(view, ms);
    messages += Count(batch, "/giveway/v3/odom");
    if (batch.messages.empty()) continue;
    last_x_m = Only<Odometry>(batch, "/giveway/v3/odom").pose.position.x;
    EXPECT_EQ(last_x_m, static_cast<double>(ms));
    EXPECT_EQ(Only<Transforms>(batch, "/tf").transforms.size(), 1U);
  }
  EXPECT_EQ(messages, 20U);
  EXPECT_EQ(last_x_m, 1900);
}

TEST(View, GivesNothingTwice) {
  View view = MakeView();
  view.Take(BeaconAt(VehicleId{3}, 1), At(0));
  EXPECT_EQ(Count(CollectAt(view, 0), "/giveway/v3/odom"), 1U);
  const Batch again = CollectAt(view, 100);
  EXPECT_EQ(Count(again, "/giveway/v3/odom"), 0U);
  EXPECT_EQ(Count(again, "/tf"), 0U);
}

TEST(View, StampsAreTheWritersAndTheTimeDueIsOurs) {
  View view = MakeView();
  view.Take(BeaconAt(VehicleId{3}, 1), {5'000'000'000, kStart_ns});  // a clock of 1970
  EXPECT_EQ(Only<Odometry>(CollectAt(view, 0), "/giveway/v3/odom").header.stamp.sec, 5);
  EXPECT_TRUE(CollectAt(view, 100).gone.empty());
}

TEST(View, EachFiringIsGivenOnceAndNoDataNotAtAll) {
  View view = MakeView();
  RangeScan scan;
  scan.vehicle = VehicleId{3};
  scan.tick = Tick{8};
  scan.readings[0] = {.kind = Echo::kEcho, .range_m = 2, .tick = Tick{8}, .fired_before_s = 0.02};
  scan.readings[1] = {.kind = Echo::kClear, .range_m = 0, .tick = Tick{8}, .fired_before_s = 0};
  view.Take(scan, At(50));
  const Batch batch = CollectAt(view, 50);
  EXPECT_EQ(Count(batch, "/giveway/v3/ultrasonics"), 2U);
  const Range first = Only<Range>(batch, "/giveway/v3/ultrasonics");
  EXPECT_EQ(first.range, 2);
  EXPECT_EQ(first.header.stamp.nanosec, 30U * kMs);  // when it fired
  scan.tick = Tick{9};
  scan.readings[1].tick = Tick{9};
  view.Take(scan, At(100));
  const Batch next = CollectAt(view, 150);
  EXPECT_EQ(Count(next, "/giveway/v3/ultrasonics"), 1U);
  EXPECT_EQ(Only<Range>(next, "/giveway/v3/ultrasonics").header.frame_id,
            "giveway_v3/ultrasonic_1");
}

TEST(View, ACommandIsATwistOnceTheDriveIsKnown) {
  View view = MakeView();
  MotorCommand command;
  command.vehicle = VehicleId{3};
  command.target = {2, 2};
  view.Take(command, At(0));
  EXPECT_EQ(Count(CollectAt(view, 0), "/giveway/v3/cmd_vel"), 0U);
  Beacon beacon = BeaconAt(VehicleId{3}, 0);
  beacon.drive = {.wheel_radius_m = 0.1, .axle_m = 0.4};
  view.Take(beacon, At(100));
  const Batch batch = CollectAt(view, 100);
  EXPECT_DOUBLE_EQ(Only<Twist>(batch, "/giveway/v3/cmd_vel").linear.x, 0.2);
  EXPECT_EQ(Count(CollectAt(view, 200), "/giveway/v3/cmd_vel"), 0U);
}

TEST(View, AVehicleThatIsSilentIsPaleThenItsMarkerIsDeleted) {
  View view = MakeView();
  view.Take(BeaconAt(VehicleId{3}, 1), At(0));
  const Batch first = CollectAt(view, 0);
  const Marker& body = Only<Markers>(first, "/giveway/markers").markers.at(0);
  EXPECT_EQ(body.action, Marker::kAdd);
  EXPECT_EQ(body.color.a, 1);
  const Batch silent = CollectAt(view, 1500);
  EXPECT_LT(Only<Markers>(silent, "/giveway/markers").markers.at(0).color.a, 1);
  const Batch gone = CollectAt(view, 3100);
  EXPECT_EQ(gone.gone, std::vector<VehicleId>{VehicleId{3}});
  const Marker& removed = Only<Markers>(gone, "/giveway/markers").markers.at(0);
  EXPECT_EQ(removed.action, Marker::kDelete);
  EXPECT_EQ(removed.id, 3);
  EXPECT_TRUE(CollectAt(view, 3200).messages.empty());
}

// They were gone three seconds after each message: seven of ten seconds the fleet was not shown.
TEST(View, AMarkerOfASlowRateStaysUntilTheNext) {
  View slow = MakeView(0.1);
  slow.Take(BeaconAt(VehicleId{3}, 1), At(0));
  EXPECT_GE(Only<Markers>(CollectAt(slow, 0), "/giveway/markers").markers.at(0).lifetime_s, 20);
  View usual = MakeView();
  usual.Take(BeaconAt(VehicleId{3}, 1), At(0));
  EXPECT_EQ(Only<Markers>(CollectAt(usual, 0), "/giveway/markers").markers.at(0).lifetime_s, 3);
}

TEST(View, TransformsThatDoNotChangeComeForANewVehicleAndEveryTenSeconds) {
  View view = MakeView();
  std::size_t messages = 0;
  for (std::uint64_t ms = 0; ms <= 20'000; ms += 100) {
    view.Take(BeaconAt(VehicleId{3}, 1), At(ms));
    if (ms >= 500) view.Take(BeaconAt(VehicleId{4}, 1), At(ms));
    const Batch batch = CollectAt(view, ms);
    messages += Count(batch, "/tf_static");
    if (ms == 0) {
      EXPECT_EQ(Only<Transforms>(batch, "/tf_static").transforms.size(), 16U);
    }
    if (ms == 500) {
      EXPECT_EQ(Only<Transforms>(batch, "/tf_static").transforms.size(), 32U);
    }
  }
  EXPECT_EQ(messages, 3U);  // at 0, 0.5 and 10.5 s
}

TEST(View, LeavesOutWhatHasNoIdOrCannotBeShown) {
  View view = MakeView();
  view.Take(BeaconAt(kNoVehicle, 1), At(0));
  view.Take(BeaconAt(VehicleId{3}, std::numeric_limits<double>::quiet_NaN()), At(0));
  EXPECT_TRUE(CollectAt(view, 0).messages.empty());
}

TEST(View, ShowsSoManyVehiclesAndNoMore) {
  View view = MakeView();
  for (std::uint32_t id = 1; id <= View::kMostVehicles + 5; ++id) {
    view.Take(BeaconAt(VehicleId{id}, 1), At(0));
  }
  EXPECT_EQ(Only<Transforms>(CollectAt(view, 0), "/tf").transforms.size(), View::kMostVehicles);
}

TEST(View, ContinuesAfterTheClockWasSetBack) {
  View view = MakeView();
  view.Take(BeaconAt(VehicleId{3}, 1), At(3'600'000));
  EXPECT_FALSE(CollectAt(view, 3'600'000).messages.empty());
  view.Take(BeaconAt(VehicleId{3}, 2), At(0));
  EXPECT_FALSE(CollectAt(view, 0).messages.empty());
  view.Take(BeaconAt(VehicleId{3}, 3), At(50));
  EXPECT_TRUE(CollectAt(view, 50).messages.empty());
}

}  // namespace
}  // namespace giveway::ros2
