// world/pose_fix: from the world to the vehicle with the sensor, and to no other.
#include <gtest/gtest.h>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/participant.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;

constexpr VehicleId kSeven{7};

RobotModel Fitted() {
  RobotModel profile;
  profile.pose_fix = {.every_s = 1, .sigma_m = 0.05};
  return profile;
}

PoseFix FixOf(VehicleId vehicle, std::uint32_t tick) {
  return {.world_from_body = {{1, 2}, 0.5},
          .sigma_position_m = 0.05,
          .vehicle = vehicle,
          .epoch = WorldEpoch{3},
          .tick = Tick{tick}};
}

TEST(PoseFixTopic, BringsItsVehicleTheNewestFix) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::VehicleLink vehicle(OptionsIn(domain));
  world.OpenVehicle(kSeven, Fitted());
  vehicle.Open(kSeven, Fitted(), false);
  ASSERT_TRUE(Eventually([&] { return world.IsMatched(kSeven); }));
  std::optional<PoseFix> fix;
  ASSERT_TRUE(Eventually([&] {
    world.SendPoseFix(FixOf(kSeven, 11));
    fix = vehicle.Take(SteadyTime{0}).inputs.pose_fix;
    return fix.has_value();
  }));
  EXPECT_EQ(fix->tick, Tick{11});
  EXPECT_EQ(fix->epoch, WorldEpoch{3});
  EXPECT_EQ(fix->world_from_body, (Pose{{1, 2}, 0.5}));
  EXPECT_EQ(fix->sigma_position_m, 0.05);
}

TEST(PoseFixTopic, IsWaitedForByTheStartWhereItIsFitted) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  world.OpenVehicle(kSeven, Fitted());
  world.OpenVehicle(VehicleId{8}, RobotModel{});
  link::VehicleLink lacking(OptionsIn(domain));
  link::VehicleLink whole(OptionsIn(domain));
  lacking.Open(kSeven, RobotModel{}, false);
  whole.Open(VehicleId{8}, RobotModel{}, false);
  EXPECT_TRUE(Eventually([&] { return world.IsMatched(VehicleId{8}); }));
  Repeat(milliseconds(200), [&] { EXPECT_FALSE(world.IsMatched(kSeven)); });
}

TEST(PoseFixTopic, AFixInAnotherVehiclesNameOrWithoutADeviationIsRefusedAndCounted) {
  const DomainLock domain;
  link::WriterNames names;
  link::Participant raw(OptionsIn(domain), "raw-world", names);
  auto writer = raw.MakeWriter<wire::PoseFix>("v7");
  link::VehicleLink vehicle(OptionsIn(domain));
  vehicle.Open(kSeven, Fitted(), false);
  EXPECT_TRUE(Eventually([&] {
    writer.Write(link::ToWire(FixOf(VehicleId{8}, 1)));
    EXPECT_FALSE(vehicle.Take(SteadyTime{0}).inputs.pose_fix.has_value());
    return vehicle.Counters().refused.wrong_name_scans > 0;
  }));
  PoseFix none = FixOf(kSeven, 1);
  none.sigma_position_m = 0;
  EXPECT_TRUE(Eventually([&] {
    writer.Write(link::ToWire(none));
    EXPECT_FALSE(vehicle.Take(SteadyTime{0}).inputs.pose_fix.has_value());
    return vehicle.Counters().refused.unreadable_samples > 0;
  }));
}

}  // namespace
}  // namespace giveway::test
