#include "services/ros2/conversion.h"

#include <cmath>
#include <initializer_list>
#include <limits>

#include "services/types/math/math.h"

namespace giveway::ros2 {
namespace {

constexpr char kMapFrame[] = "map";
constexpr double kMarkerHeight_m = 0.2;
constexpr float kPale = 0.35F;

std::string FramePrefix(VehicleId vehicle) {
  return "giveway_v" + std::to_string(Number(vehicle)) + "/";
}

Pose PoseOf(const giveway::Pose& world_from_body) {
  return {{world_from_body.position_world.x, world_from_body.position_world.y, 0},
          QuaternionOf(world_from_body.heading_rad)};
}

Covariance CovarianceOf(const PoseCovariance& c) {
  constexpr std::size_t kX = 0;
  constexpr std::size_t kY = 1;
  constexpr std::size_t kYaw = 5;
  Covariance rows{};
  const auto set = [&rows](std::size_t a, std::size_t b, double value) {
    rows[6 * a + b] = value;
    rows[6 * b + a] = value;
  };
  set(kX, kX, c.xx_m2);
  set(kX, kY, c.xy_m2);
  set(kY, kY, c.yy_m2);
  set(kX, kYaw, c.xh_m_rad);
  set(kY, kYaw, c.yh_m_rad);
  set(kYaw, kYaw, c.hh_rad2);
  return rows;
}

// Those of the page, light.
Color ColorOf(Mode mode) {
  constexpr auto color = [](int r, int g, int b) {
    constexpr float kFull = 255;
    return Color{static_cast<float>(r) / kFull, static_cast<float>(g) / kFull,
                 static_cast<float>(b) / kFull, 1};
  };
  switch (mode) {
    case Mode::kCooperative:
      return color(0x1f, 0x77, 0xb4);
    case Mode::kSensorOnly:
      return color(0xc7, 0x77, 0x00);
    case Mode::kHalt:
      return color(0xc6, 0x28, 0x28);
    case Mode::kLeaving:
      break;
  }
  return color(0x7a, 0x7f, 0x87);
}

}  // namespace

Time TimeOf(std::uint64_t since_1970_ns) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  return {static_cast<std::int32_t>(since_1970_ns / kSecond),
          static_cast<std::uint32_t>(since_1970_ns % kSecond)};
}

Quaternion QuaternionOf(double heading_rad) {
  const SineCosine half = SinCos(heading_rad / 2);
  return {0, 0, half.sine, half.cosine};
}

std::string Namespace(VehicleId vehicle) {
  return "/giveway/v" + std::to_string(Number(vehicle)) + "/";
}
std::string BodyFrame(VehicleId vehicle) { return FramePrefix(vehicle) + "base_link"; }
std::string SensorFrame(VehicleId vehicle, std::size_t sensor) {
  return FramePrefix(vehicle) + "ultrasonic_" + std::to_string(sensor);
}

bool CanShow(const Beacon& beacon) {
  const PoseCovariance& c = beacon.covariance;
  for (const double number :
       {beacon.world_from_body.position_world.x, beacon.world_from_body.position_world.y,
        beacon.world_from_body.heading_rad, beacon.wheels.left_rad_s, beacon.wheels.right_rad_s,
        beacon.drive.wheel_radius_m, beacon.drive.axle_m, beacon.body_radius_m, c.xx_m2, c.xy_m2,
        c.yy_m2, c.xh_m_rad, c.yh_m_rad, c.hh_rad2}) {
    if (!std::isfinite(number)) return false;
  }
  return beacon.drive.axle_m > 0 && Magnitude(beacon.world_from_body.heading_rad) <= 2 * kPi;
}

Twist TwistOf(const DriveGeometry& drive, WheelSpeeds wheels) {
  const giveway::Twist twist = TwistFromWheels(drive, wheels);
  return {{twist.forward_m_s, 0, 0}, {0, 0, twist.turn_rad_s}};
}

Odometry OdometryOf(const Beacon& beacon, std::uint64_t stamp_ns) {
  Odometry odometry;
  odometry.header = {TimeOf(stamp_ns), kMapFrame};
  odometry.child_frame_id = BodyFrame(beacon.vehicle);
  odometry.pose = PoseOf(beacon.world_from_body);
  odometry.pose_covariance = CovarianceOf(beacon.covariance);
  odometry.twist = TwistOf(beacon.drive, beacon.wheels);
  return odometry;
}

Transform BodyTransform(const Beacon& beacon, std::uint64_t stamp_ns) {
  const Pose pose = PoseOf(beacon.world_from_body);
  return {
      {TimeOf(stamp_ns), kMapFrame}, BodyFrame(beacon.vehicle), pose.position, pose.orientation};
}

Transform SensorTransform(VehicleId vehicle, const RobotModel& profile, std::size_t sensor,
                          std::uint64_t stamp_ns) {
  const SensorMount& mount = profile.sonar[sensor];
  return {{TimeOf(stamp_ns), BodyFrame(vehicle)},
          SensorFrame(vehicle, sensor),
          {mount.position_body.x, mount.position_body.y, 0},
          QuaternionOf(mount.bearing_rad)};
}

Range RangeOf(VehicleId vehicle, const RobotModel& profile, std::size_t sensor,
              const RangeReading& reading, std::uint64_t stamp_ns) {
  Range range;
  range.header = {TimeOf(stamp_ns), SensorFrame(vehicle, sensor)};
  range.field_of_view = static_cast<float>(2 * profile.sonar_half_angle_rad);
  range.max_range = static_cast<float>(profile.sonar_max_range_m);
  range.range = reading.kind == Echo::kEcho ? static_cast<float>(reading.range_m)
                                            : std::numeric_limits<float>::infinity();
  return range;
}

Marker BodyMarker(const Beacon& beacon, std::uint64_t stamp_ns, bool silent,
                  std::int32_t lifetime_s) {
  Marker marker = RemovedMarker(beacon.vehicle, stamp_ns);
  marker.action = Marker::kAdd;
  marker.pose = PoseOf(beacon.world_from_body);
  marker.pose.position.z = kMarkerHeight_m / 2;  // of its middle: it stands on the ground
  marker.scale = {2 * beacon.body_radius_m, 2 * beacon.body_radius_m, kMarkerHeight_m};
  marker.color = ColorOf(beacon.mode);
  if (silent) marker.color.a = kPale;
  marker.lifetime_s = lifetime_s;
  return marker;
}

Marker RemovedMarker(VehicleId vehicle, std::uint64_t stamp_ns) {
  Marker marker;
  marker.header = {TimeOf(stamp_ns), kMapFrame};
  marker.ns = "giveway";
  marker.id = static_cast<std::int32_t>(Number(vehicle));
  marker.action = Marker::kDelete;
  return marker;
}

}  // namespace giveway::ros2
