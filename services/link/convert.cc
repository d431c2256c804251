// What travels every tick: beacon, scan, command, truth.
#include "services/link/convert.h"

#include <array>
#include <bit>
#include <cstring>

#include "services/link/convert_parts.h"
#include "services/link/crc32c.h"

namespace giveway::link {
namespace {

// Packs fields without padding, little-endian, in the order they are added.
template <std::size_t kBytes>
class Packer {
 public:
  static_assert(std::endian::native == std::endian::little, "swap bytes in Add");

  template <typename T>
  Packer& Add(T value) {
    std::memcpy(&bytes_[used_], &value, sizeof(value));
    used_ += sizeof(value);
    return *this;
  }
  std::span<const std::uint8_t> Bytes() const { return {bytes_.data(), used_}; }

 private:
  std::array<std::uint8_t, kBytes> bytes_;
  std::size_t used_ = 0;
};

}  // namespace

std::uint32_t BeaconCrc(const wire::Beacon& beacon) {
  const wire::PlanarPose& pose = beacon.world_from_body();
  Packer<108> packer;
  packer.Add(beacon.vehicle()).Add(beacon.boot_epoch()).Add(beacon.seq());
  packer.Add(beacon.world_epoch()).Add(beacon.tick());
  packer.Add(beacon.left_rad_s()).Add(beacon.right_rad_s()).Add(beacon.cruise_m_s());
  packer.Add(pose.x_m()).Add(pose.y_m()).Add(pose.heading_rad());
  packer.Add(beacon.sigma_position_m()).Add(beacon.sigma_heading_rad());
  packer.Add(static_cast<std::uint32_t>(beacon.mode()));
  packer.Add(static_cast<std::uint32_t>(beacon.rule()));
  packer.Add(beacon.gives_way_to()).Add(beacon.order_waited_ticks());
  packer.Add(beacon.order_speed_bucket()).Add(beacon.order_vehicle());
  return Crc32c(packer.Bytes());
}

wire::Beacon ToWire(const Beacon& beacon) {
  wire::Beacon sent;
  sent.vehicle(Number(beacon.vehicle));
  sent.boot_epoch(beacon.boot_epoch);
  sent.seq(beacon.seq);
  sent.world_epoch(Number(beacon.world_epoch));
  sent.tick(Number(beacon.tick));
  sent.left_rad_s(beacon.wheels.left_rad_s);
  sent.right_rad_s(beacon.wheels.right_rad_s);
  sent.cruise_m_s(beacon.cruise_m_s);
  sent.world_from_body(ToWirePart(beacon.world_from_body));
  sent.sigma_position_m(beacon.sigma_position_m);
  sent.sigma_heading_rad(beacon.sigma_heading_rad);
  sent.mode(ToWireEnum<wire::DriveMode>(beacon.mode));
  sent.rule(ToWireEnum<wire::DriveRule>(beacon.rule));
  sent.gives_way_to(Number(beacon.gives_way_to));
  sent.order_waited_ticks(beacon.order.waited_ticks);
  sent.order_speed_bucket(beacon.order.speed_bucket);
  sent.order_vehicle(Number(beacon.order.vehicle));
  sent.crc(BeaconCrc(sent));
  return sent;
}

bool FromWire(const wire::Beacon& sample, Beacon& beacon) {
  beacon.vehicle = VehicleId{sample.vehicle()};
  beacon.boot_epoch = sample.boot_epoch();
  beacon.seq = sample.seq();
  beacon.world_epoch = WorldEpoch{sample.world_epoch()};
  beacon.tick = Tick{sample.tick()};
  beacon.wheels = {sample.left_rad_s(), sample.right_rad_s()};
  beacon.cruise_m_s = sample.cruise_m_s();
  beacon.world_from_body = FromWirePart(sample.world_from_body());
  beacon.sigma_position_m = sample.sigma_position_m();
  beacon.sigma_heading_rad = sample.sigma_heading_rad();
  beacon.gives_way_to = VehicleId{sample.gives_way_to()};
  beacon.order = {sample.order_waited_ticks(), sample.order_speed_bucket(),
                  VehicleId{sample.order_vehicle()}};
  const bool mode_known = FromWirePart(sample.mode(), beacon.mode);
  return FromWirePart(sample.rule(), beacon.rule) && mode_known;
}

wire::RangeScan ToWire(const RangeScan& scan) {
  wire::RangeScan sent;
  sent.vehicle(Number(scan.vehicle));
  sent.world_epoch(Number(scan.epoch));
  sent.tick(Number(scan.tick));
  sent.run_state(ToWireEnum<wire::RunPhase>(scan.run_state));
  sent.left_rad_s(scan.wheels.left_rad_s);
  sent.right_rad_s(scan.wheels.right_rad_s);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    sent.echo()[i] = ToWireEnum<wire::EchoKind>(scan.readings[i].kind);
    sent.range_m()[i] = scan.readings[i].range_m;
    sent.fired_tick()[i] = Number(scan.readings[i].tick);
  }
  return sent;
}

bool FromWire(const wire::RangeScan& sample, RangeScan& scan) {
  scan.vehicle = VehicleId{sample.vehicle()};
  scan.epoch = WorldEpoch{sample.world_epoch()};
  scan.tick = Tick{sample.tick()};
  scan.wheels = {sample.left_rad_s(), sample.right_rad_s()};
  bool known = FromWirePart(sample.run_state(), scan.run_state);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    known &= FromWirePart(sample.echo()[i], scan.readings[i].kind);
    scan.readings[i].range_m = sample.range_m()[i];
    scan.readings[i].tick = Tick{sample.fired_tick()[i]};
  }
  return known;
}

wire::MotorCommand ToWire(const MotorCommand& command) {
  wire::MotorCommand sent;
  sent.vehicle(Number(command.vehicle));
  sent.world_epoch(Number(command.epoch));
  sent.tick(Number(command.tick));
  sent.left_rad_s(command.target.left_rad_s);
  sent.right_rad_s(command.target.right_rad_s);
  sent.decision(ToWirePart(command.decision));
  sent.decision_changed(command.decision_changed);
  sent.matched_peers(command.matched_peers);
  return sent;
}

bool FromWire(const wire::MotorCommand& sample, MotorCommand& command) {
  command.vehicle = VehicleId{sample.vehicle()};
  command.epoch = WorldEpoch{sample.world_epoch()};
  command.tick = Tick{sample.tick()};
  command.target = {sample.left_rad_s(), sample.right_rad_s()};
  command.decision_changed = sample.decision_changed();
  command.matched_peers = sample.matched_peers();
  return FromWirePart(sample.decision(), command.decision);
}

wire::Truth ToWire(const Truth& truth) {
  wire::Truth sent;
  sent.vehicle(Number(truth.vehicle));
  sent.world_epoch(Number(truth.epoch));
  sent.tick(Number(truth.tick));
  sent.time_s(truth.time_s);
  sent.world_from_body(ToWirePart(truth.world_from_body));
  sent.left_rad_s(truth.wheels.left_rad_s);
  sent.right_rad_s(truth.wheels.right_rad_s);
  sent.forward_m_s(truth.forward_m_s);
  sent.present(truth.present);
  sent.arrived(truth.arrived);
  return sent;
}

bool FromWire(const wire::Truth& sample, Truth& truth) {
  truth.vehicle = VehicleId{sample.vehicle()};
  truth.epoch = WorldEpoch{sample.world_epoch()};
  truth.tick = Tick{sample.tick()};
  truth.time_s = sample.time_s();
  truth.world_from_body = FromWirePart(sample.world_from_body());
  truth.wheels = {sample.left_rad_s(), sample.right_rad_s()};
  truth.forward_m_s = sample.forward_m_s();
  truth.present = sample.present();
  truth.arrived = sample.arrived();
  return true;
}

}  // namespace giveway::link
