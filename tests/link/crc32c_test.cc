#include "services/link/convert/crc32c.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "services/link/convert/convert.h"

namespace giveway::link {
namespace {

std::uint32_t CrcOfText(std::string_view text) {
  return Crc32c({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(Crc32c, GivesTheCatalogueCheckValue) { EXPECT_EQ(CrcOfText("123456789"), 0xe3069283U); }

TEST(Crc32c, IsTheSameByInstructionAndByTable) {
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t i = 0; i < 300; ++i) {
    EXPECT_EQ(Crc32c(bytes), PortableCrc32c(bytes)) << "length " << i;
    bytes.push_back(static_cast<std::uint8_t>(i * 167U));
  }
}

TEST(Crc32c, OfNothingIsZero) { EXPECT_EQ(CrcOfText(""), 0U); }

Beacon TestVector() {
  Beacon beacon;
  beacon.vehicle = VehicleId{7};
  beacon.boot_epoch = 3735928559U;
  beacon.seq = 3;
  beacon.world_epoch = WorldEpoch{4};
  beacon.tick = Tick{5};
  beacon.wheels = {1.5, -2.25};
  beacon.cruise_m_s = 0.4;
  beacon.world_from_body = {{1.0, -2.0}, 0.5};
  beacon.covariance = {0.5, -0.125, 0.25, 0.03125, -0.0625, 0.015625};
  beacon.mode = Mode::kSensorOnly;
  beacon.rule = Rule::kGiveWay;
  beacon.toward_world = {3.0, -4.0};
  beacon.gives_way_to = VehicleId{2};
  beacon.blocked_by = VehicleId{9};
  beacon.order = {6, 8, VehicleId{7}};
  return beacon;
}

TEST(BeaconCrc, IsTheTestVectorOfTheIdl) { EXPECT_EQ(ToWire(TestVector()).crc(), 0x4babb897U); }

TEST(BeaconCrc, CoversEveryField) {
  using Change = void (*)(wire::Beacon&);
  const Change changes[] = {[](wire::Beacon& b) { b.vehicle() ^= 1; },
                            [](wire::Beacon& b) { b.boot_epoch() ^= 1; },
                            [](wire::Beacon& b) { b.seq() ^= 1; },
                            [](wire::Beacon& b) { b.world_epoch() ^= 1; },
                            [](wire::Beacon& b) { b.tick() ^= 1; },
                            [](wire::Beacon& b) { b.left_rad_s() += 1; },
                            [](wire::Beacon& b) { b.right_rad_s() += 1; },
                            [](wire::Beacon& b) { b.cruise_m_s() += 1; },
                            [](wire::Beacon& b) { b.world_from_body().x_m() += 1; },
                            [](wire::Beacon& b) { b.world_from_body().y_m() += 1; },
                            [](wire::Beacon& b) { b.world_from_body().heading_rad() += 1; },
                            [](wire::Beacon& b) { b.covariance().xx_m2() += 1; },
                            [](wire::Beacon& b) { b.covariance().xy_m2() += 1; },
                            [](wire::Beacon& b) { b.covariance().yy_m2() += 1; },
                            [](wire::Beacon& b) { b.covariance().xh_m_rad() += 1; },
                            [](wire::Beacon& b) { b.covariance().yh_m_rad() += 1; },
                            [](wire::Beacon& b) { b.covariance().hh_rad2() += 1; },
                            [](wire::Beacon& b) { b.body_radius_m() += 1; },
                            [](wire::Beacon& b) { b.wheel_radius_m() += 1; },
                            [](wire::Beacon& b) { b.axle_m() += 1; },
                            [](wire::Beacon& b) { b.acceleration_m_s2() += 1; },
                            [](wire::Beacon& b) { b.deceleration_m_s2() += 1; },
                            [](wire::Beacon& b) { b.toward_x_m() += 1; },
                            [](wire::Beacon& b) { b.toward_y_m() += 1; },
                            [](wire::Beacon& b) { b.blocked_by() ^= 1; },
                            [](wire::Beacon& b) { b.mode(wire::DriveMode::MODE_HALT); },
                            [](wire::Beacon& b) { b.rule(wire::DriveRule::RULE_DEAF); },
                            [](wire::Beacon& b) { b.gives_way_to() ^= 1; },
                            [](wire::Beacon& b) { b.order_waited_ticks() ^= 1; },
                            [](wire::Beacon& b) { b.order_speed_bucket() ^= 1; },
                            [](wire::Beacon& b) { b.order_vehicle() ^= 1; }};
  Beacon sound;
  EXPECT_TRUE(FromWire(ToWire(TestVector()), sound).crc_valid);
  int field = 0;
  for (const Change change : changes) {
    wire::Beacon sent = ToWire(TestVector());
    change(sent);
    Beacon back;
    EXPECT_FALSE(FromWire(sent, back).crc_valid) << "field " << field;
    ++field;
  }
}

}  // namespace
}  // namespace giveway::link
