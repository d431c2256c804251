// What travels every tick: beacon, scan, command, truth.
#include "services/link/convert/convert.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "services/link/convert/convert_parts.h"
#include "services/link/convert/crc32c.h"
#include "services/types/check.h"

namespace giveway::link {
namespace {

// Packs fields without padding, little-endian, in the order they are added. Builds whole words in a
// register: bytes stored one field at a time would stall the checksum that reads them back.
class Packer {
 public:
  template <typename T>
  requires(sizeof(T) == 4) void Add(T value) {
    const auto bits = std::uint64_t{static_cast<std::uint32_t>(value)};
    if (half_) Push(pending_ | bits << 32U);
    pending_ = bits;
    half_ = !half_;
  }
  void Add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    Push(half_ ? pending_ | bits << 32U : bits);
    pending_ = bits >> 32U;
  }
  std::span<const std::uint8_t> Bytes() {
    static_assert(std::endian::native == std::endian::little, "words are read as bytes");
    words_[used_] = pending_;
    return {reinterpret_cast<const std::uint8_t*>(words_.data()), 8 * used_ + (half_ ? 4 : 0)};
  }

 private:
  void Push(std::uint64_t word) {
    GIVEWAY_CHECK(used_ + 1 < words_.size(), used_);  // one stays free for the last half
    words_[used_++] = word;
  }

  std::array<std::uint64_t, 26> words_;  // 200 bytes, and space for one more field of 4
  std::size_t used_ = 0;
  std::uint64_t pending_ = 0;  // low half: the last 32 bits added, while half_
  bool half_ = false;
};

// Packed from our fields and not from the sample's, whose every access is a call. Mode and rule are
// the numbers sent: they may be none of ours.
std::uint32_t Crc(const Beacon& beacon, wire::DriveMode mode, wire::DriveRule rule) {
  const Pose& pose = beacon.world_from_body;
  Packer packer;
  packer.Add(beacon.vehicle);
  packer.Add(beacon.boot_epoch);
  packer.Add(beacon.seq);
  packer.Add(beacon.world_epoch);
  packer.Add(beacon.tick);
  packer.Add(beacon.wheels.left_rad_s);
  packer.Add(beacon.wheels.right_rad_s);
  packer.Add(beacon.cruise_m_s);
  packer.Add(pose.position_world.x);
  packer.Add(pose.position_world.y);
  packer.Add(pose.heading_rad);
  packer.Add(beacon.covariance.xx_m2);
  packer.Add(beacon.covariance.xy_m2);
  packer.Add(beacon.covariance.yy_m2);
  packer.Add(beacon.covariance.xh_m_rad);
  packer.Add(beacon.covariance.yh_m_rad);
  packer.Add(beacon.covariance.hh_rad2);
  packer.Add(beacon.body_radius_m);
  packer.Add(beacon.drive.wheel_radius_m);
  packer.Add(beacon.drive.axle_m);
  packer.Add(beacon.acceleration_m_s2);
  packer.Add(beacon.deceleration_m_s2);
  packer.Add(beacon.toward_world.x);
  packer.Add(beacon.toward_world.y);
  packer.Add(mode);
  packer.Add(rule);
  packer.Add(beacon.gives_way_to);
  packer.Add(beacon.blocked_by);
  packer.Add(beacon.order.waited_ticks);
  packer.Add(beacon.order.speed_bucket);
  packer.Add(beacon.order.vehicle);
  return Crc32c(packer.Bytes());
}

// An enumerator that this build does not know, where there is one.
template <typename Wire, typename Ours>
std::optional<FieldFault> EnumFault(const char* field, Wire sent, Ours last) {
  const auto number = static_cast<std::uint32_t>(sent);
  const auto most = static_cast<std::uint32_t>(last);
  if (number <= most) return std::nullopt;
  return FieldFault{field, static_cast<double>(number), 0, static_cast<double>(most)};
}

}  // namespace

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
  sent.covariance(ToWirePart(beacon.covariance));
  sent.body_radius_m(beacon.body_radius_m);
  sent.wheel_radius_m(beacon.drive.wheel_radius_m);
  sent.axle_m(beacon.drive.axle_m);
  sent.acceleration_m_s2(beacon.acceleration_m_s2);
  sent.deceleration_m_s2(beacon.deceleration_m_s2);
  sent.toward_x_m(beacon.toward_world.x);
  sent.toward_y_m(beacon.toward_world.y);
  sent.mode(ToWireEnum<wire::DriveMode>(beacon.mode));
  sent.rule(ToWireEnum<wire::DriveRule>(beacon.rule));
  sent.gives_way_to(Number(beacon.gives_way_to));
  sent.blocked_by(Number(beacon.blocked_by));
  sent.order_waited_ticks(beacon.order.waited_ticks);
  sent.order_speed_bucket(beacon.order.speed_bucket);
  sent.order_vehicle(Number(beacon.order.vehicle));
  sent.crc(Crc(beacon, sent.mode(), sent.rule()));
  return sent;
}

Arrival FromWire(const wire::Beacon& sample, Beacon& beacon) {
  const wire::PlanarPose& pose = sample.world_from_body();
  const wire::DriveMode mode = sample.mode();
  const wire::DriveRule rule = sample.rule();
  beacon.vehicle = VehicleId{sample.vehicle()};
  beacon.boot_epoch = sample.boot_epoch();
  beacon.seq = sample.seq();
  beacon.world_epoch = WorldEpoch{sample.world_epoch()};
  beacon.tick = Tick{sample.tick()};
  beacon.wheels = {sample.left_rad_s(), sample.right_rad_s()};
  beacon.cruise_m_s = sample.cruise_m_s();
  beacon.world_from_body = {{pose.x_m(), pose.y_m()}, pose.heading_rad()};
  FromWirePart(sample.covariance(), beacon.covariance);
  beacon.body_radius_m = sample.body_radius_m();
  beacon.drive = {sample.wheel_radius_m(), sample.axle_m()};
  beacon.acceleration_m_s2 = sample.acceleration_m_s2();
  beacon.deceleration_m_s2 = sample.deceleration_m_s2();
  beacon.toward_world = {sample.toward_x_m(), sample.toward_y_m()};
  beacon.gives_way_to = VehicleId{sample.gives_way_to()};
  beacon.blocked_by = VehicleId{sample.blocked_by()};
  beacon.order = {sample.order_waited_ticks(), sample.order_speed_bucket(),
                  VehicleId{sample.order_vehicle()}};
  const bool mode_known = FromWirePart(mode, beacon.mode);
  const std::uint32_t crc = Crc(beacon, mode, rule);
  return {.crc_valid = sample.crc() == crc,
          .readable = FromWirePart(rule, beacon.rule) && mode_known,
          .crc = crc};
}

FieldFault FaultOf(const wire::Beacon& sample) {
  if (const auto fault = EnumFault("mode", sample.mode(), Mode::kLeaving)) return *fault;
  return EnumFault("rule", sample.rule(), kLastRule).value_or(FieldFault{});
}

wire::RangeScan ToWire(const RangeScan& scan) {
  wire::RangeScan sent;
  sent.vehicle(Number(scan.vehicle));
  sent.world_epoch(Number(scan.epoch));
  sent.tick(Number(scan.tick));
  sent.run_state(ToWireEnum<wire::RunPhase>(scan.run_state));
  sent.left_rad_s(scan.wheels.left_rad_s);
  sent.right_rad_s(scan.wheels.right_rad_s);
  sent.counted_left_rad(scan.counted.left_rad);
  sent.counted_right_rad(scan.counted.right_rad);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    sent.echo()[i] = ToWireEnum<wire::EchoKind>(scan.readings[i].kind);
    sent.range_m()[i] = scan.readings[i].range_m;
    sent.fired_tick()[i] = Number(scan.readings[i].tick);
    sent.fired_before_s()[i] = scan.readings[i].fired_before_s;
  }
  return sent;
}

bool FromWire(const wire::RangeScan& sample, RangeScan& scan) {
  scan.vehicle = VehicleId{sample.vehicle()};
  scan.epoch = WorldEpoch{sample.world_epoch()};
  scan.tick = Tick{sample.tick()};
  scan.wheels = {sample.left_rad_s(), sample.right_rad_s()};
  scan.counted = {sample.counted_left_rad(), sample.counted_right_rad()};
  bool known = FromWirePart(sample.run_state(), scan.run_state);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    known &= FromWirePart(sample.echo()[i], scan.readings[i].kind);
    scan.readings[i].range_m = sample.range_m()[i];
    scan.readings[i].tick = Tick{sample.fired_tick()[i]};
    scan.readings[i].fired_before_s = sample.fired_before_s()[i];
    known &= std::isfinite(scan.readings[i].fired_before_s);
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
  sent.waypoint(command.task.waypoint);
  sent.waited_ticks(command.task.waited_ticks);
  return sent;
}

bool FromWire(const wire::MotorCommand& sample, MotorCommand& command) {
  command.vehicle = VehicleId{sample.vehicle()};
  command.epoch = WorldEpoch{sample.world_epoch()};
  command.tick = Tick{sample.tick()};
  command.target = {sample.left_rad_s(), sample.right_rad_s()};
  command.decision_changed = sample.decision_changed();
  command.matched_peers = sample.matched_peers();
  command.task = {sample.waypoint(), sample.waited_ticks()};
  return FromWirePart(sample.decision(), command.decision);
}

FieldFault FaultOf(const wire::MotorCommand& sample) {
  constexpr double kMost = std::numeric_limits<double>::max();
  if (!std::isfinite(sample.left_rad_s())) {
    return {"left_rad_s", sample.left_rad_s(), -kMost, kMost};
  }
  if (!std::isfinite(sample.right_rad_s())) {
    return {"right_rad_s", sample.right_rad_s(), -kMost, kMost};
  }
  const wire::DecisionRecord& decision = sample.decision();
  if (const auto fault = EnumFault("decision.mode", decision.mode(), Mode::kLeaving)) return *fault;
  return EnumFault("decision.rule", decision.rule(), kLastRule).value_or(FieldFault{});
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
  return std::isfinite(truth.time_s) && IsFinite(truth.world_from_body);
}

}  // namespace giveway::link
