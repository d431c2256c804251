// What the sensors besides the ultrasonics deliver: radar, single-line lidar, camera. All sit at
// the axle centre and look forward; bearings are counter-clockwise from the body's x axis, in (-pi,
// pi]. Each has its own topic. None knows what it sees to be an obstacle: that is the brain's to
// decide.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/types/ids.h"
#include "services/types/range_scan.h"

namespace giveway {

inline constexpr std::size_t kMaxDetections = 32;  // of a radar or a camera; the nearest win
inline constexpr std::size_t kLidarBeams = 181;

// Two beams in one housing: long and narrow, short and wide.
inline constexpr double kRadarLongRange_m = 20;
inline constexpr double kRadarLongHalfAngle_rad = 0.17453292519943295;  // 10 degrees
inline constexpr double kRadarShortRange_m = 6;
inline constexpr double kRadarShortHalfAngle_rad = 0.6981317007977318;  // 40 degrees

struct RadarDetection {
  double range_m = 0;         // from the axle centre to the nearest point of the surface
  double bearing_rad = 0;     // of that point
  double range_rate_m_s = 0;  // negative: coming nearer; the own motion is in it
  bool long_range = false;    // seen by the long beam
};

struct RadarScan {
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  std::uint32_t count = 0;                                  // at most kMaxDetections
  std::array<RadarDetection, kMaxDetections> detections{};  // nearest first
};

// One line, a half circle ahead, one beam a degree: beam i looks at (i - 90) degrees.
inline constexpr double kLidarRange_m = 10;

struct LidarScan {
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  std::array<Echo, kLidarBeams> echo{};
  std::array<double, kLidarBeams> range_m{};  // from the axle centre; only where echo is kEcho
};

// What a camera can distinguish.
enum class SeenClass : std::uint8_t { kUnknown, kVehicle, kCart, kFixture, kSignal };

inline constexpr double kCameraRange_m = 15;
inline constexpr double kCameraHalfAngle_rad = 0.5235987755982988;  // 30 degrees

struct CameraObject {
  SeenClass seen_class = SeenClass::kUnknown;
  double bearing_rad = 0;     // of its middle
  double half_width_rad = 0;  // half the angle it fills
};

struct CameraScan {
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  std::uint32_t count = 0;                             // at most kMaxDetections
  std::array<CameraObject, kMaxDetections> objects{};  // nearest first
};

}  // namespace giveway
