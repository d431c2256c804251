#include "services/link/inbox/sample_check.h"

#include <algorithm>
#include <limits>

#include "services/link/inbox/field_ranges.h"

namespace giveway::link {
namespace {

constexpr double kMost32 = std::numeric_limits<std::uint32_t>::max();
constexpr double kMostRange_m = 1000;
constexpr double kMostRangeRate_m_s = 200;
constexpr double kMostFiredBefore_s = 10;
constexpr double kMostToChange_s = 1e6;

template <typename Scan>
void HoldOrigin(const Scan& scan, FieldRanges* ranges) {
  ranges->Hold("world_epoch", Number(scan.epoch), 1, kMost32);
  ranges->Hold("tick", Number(scan.tick), 1, kMost32);
}

}  // namespace

std::optional<FieldFault> FaultOf(const RangeScan& scan) {
  FieldRanges ranges;
  HoldOrigin(scan, &ranges);
  ranges.HoldRate("left_rad_s", scan.wheels.left_rad_s);
  ranges.HoldRate("right_rad_s", scan.wheels.right_rad_s);
  ranges.HoldCounted("counted_left_rad", scan.counted.left_rad);
  ranges.HoldCounted("counted_right_rad", scan.counted.right_rad);
  for (const RangeReading& reading : scan.readings) {
    if (reading.kind == Echo::kEcho) ranges.Hold("range_m", reading.range_m, 0, kMostRange_m);
    ranges.Hold("fired_tick", Number(reading.tick), 0, Number(scan.tick));
    ranges.Hold("fired_before_s", reading.fired_before_s, 0, kMostFiredBefore_s);
  }
  return ranges.Fault();
}

std::optional<FieldFault> FaultOf(const RadarScan& scan) {
  FieldRanges ranges;
  HoldOrigin(scan, &ranges);
  for (std::size_t i = 0; i < std::min<std::size_t>(scan.count, kMaxDetections); ++i) {
    const RadarDetection& detection = scan.detections[i];
    ranges.Hold("detections.range_m", detection.range_m, 0, kMostRange_m);
    ranges.HoldBearing("detections.bearing_rad", detection.bearing_rad);
    ranges.Hold("detections.range_rate_m_s", detection.range_rate_m_s, -kMostRangeRate_m_s,
                kMostRangeRate_m_s);
  }
  return ranges.Fault();
}

std::optional<FieldFault> FaultOf(const LidarScan& scan) {
  FieldRanges ranges;
  HoldOrigin(scan, &ranges);
  for (std::size_t i = 0; i < kLidarBeams; ++i) {
    if (scan.echo[i] == Echo::kEcho) ranges.Hold("range_m", scan.range_m[i], 0, kMostRange_m);
  }
  return ranges.Fault();
}

std::optional<FieldFault> FaultOf(const CameraScan& scan) {
  FieldRanges ranges;
  HoldOrigin(scan, &ranges);
  for (std::size_t i = 0; i < std::min<std::size_t>(scan.count, kMaxDetections); ++i) {
    ranges.HoldBearing("objects.bearing_rad", scan.objects[i].bearing_rad);
    ranges.Hold("objects.half_width_rad", scan.objects[i].half_width_rad, 0, kPi);
  }
  return ranges.Fault();
}

std::optional<FieldFault> FaultOf(const PoseFix& fix) {
  FieldRanges ranges;
  HoldOrigin(fix, &ranges);
  ranges.HoldPlace("x_m", fix.world_from_body.position_world.x);
  ranges.HoldPlace("y_m", fix.world_from_body.position_world.y);
  ranges.HoldBearing("heading_rad", fix.world_from_body.heading_rad);
  ranges.Hold("sigma_position_m", fix.sigma_position_m, kLeastFixSigma_m, kMostFixSigma_m);
  // None, or at least so much.
  const double least_rad = fix.sigma_heading_rad == 0 ? 0 : kLeastFixSigma_rad;
  ranges.Hold("sigma_heading_rad", fix.sigma_heading_rad, least_rad, kPi);
  return ranges.Fault();
}

std::optional<FieldFault> FaultOf(const SignalState& state) {
  FieldRanges ranges;
  ranges.Hold("signal", Number(state.id), 1, kMost32);
  HoldOrigin(state, &ranges);
  ranges.HoldPlace("line_from_x_m", state.line_from_world.x);
  ranges.HoldPlace("line_from_y_m", state.line_from_world.y);
  ranges.HoldPlace("line_to_x_m", state.line_to_world.x);
  ranges.HoldPlace("line_to_y_m", state.line_to_world.y);
  ranges.HoldBearing("travel_rad", state.travel_rad);
  ranges.Hold("to_change_s", state.to_change_s, 0, kMostToChange_s);
  return ranges.Fault();
}

std::optional<FieldFault> FaultOf(const MotorCommand& command) {
  FieldRanges ranges;
  ranges.HoldRate("left_rad_s", command.target.left_rad_s);
  ranges.HoldRate("right_rad_s", command.target.right_rad_s);
  return ranges.Fault();
}

}  // namespace giveway::link
