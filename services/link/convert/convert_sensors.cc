// What radar, lidar, camera and signal heads say. No brain could check these numbers against
// anything, so what is not finite ends here.
#include <cmath>

#include "services/link/convert/convert.h"
#include "services/link/convert/convert_parts.h"
#include "services/types/check.h"

namespace giveway::link {
namespace {

template <typename Wire, typename Ours>
void SetOrigin(const Ours& scan, Wire& sent) {
  sent.vehicle(Number(scan.vehicle));
  sent.world_epoch(Number(scan.epoch));
  sent.tick(Number(scan.tick));
}

template <typename Wire, typename Ours>
void GetOrigin(const Wire& sample, Ours& scan) {
  scan.vehicle = VehicleId{sample.vehicle()};
  scan.epoch = WorldEpoch{sample.world_epoch()};
  scan.tick = Tick{sample.tick()};
}

// False, setting nothing, if there are more than fit: the type support lets a longer list through.
template <typename List>
bool GetCount(const List& list, std::uint32_t& count) {
  if (list.size() > kMaxDetections) return false;
  count = static_cast<std::uint32_t>(list.size());
  return true;
}

template <typename... Numbers>
bool AreFinite(Numbers... numbers) {
  return (std::isfinite(numbers) && ...);
}

}  // namespace

wire::RadarScan ToWire(const RadarScan& scan) {
  GIVEWAY_CHECK(scan.count <= kMaxDetections, scan.count);
  wire::RadarScan sent;
  SetOrigin(scan, sent);
  sent.detections().resize(scan.count);
  for (std::size_t i = 0; i < scan.count; ++i) {
    const RadarDetection& detection = scan.detections[i];
    wire::RadarDetection& out = sent.detections()[i];
    out.range_m(detection.range_m);
    out.bearing_rad(detection.bearing_rad);
    out.range_rate_m_s(detection.range_rate_m_s);
    out.long_range(detection.long_range);
  }
  return sent;
}

bool FromWire(const wire::RadarScan& sample, RadarScan& scan) {
  GetOrigin(sample, scan);
  if (!GetCount(sample.detections(), scan.count)) return false;
  bool finite = true;
  for (std::size_t i = 0; i < scan.count; ++i) {
    const wire::RadarDetection& sent = sample.detections()[i];
    scan.detections[i] = {sent.range_m(), sent.bearing_rad(), sent.range_rate_m_s(),
                          sent.long_range()};
    finite &= AreFinite(sent.range_m(), sent.bearing_rad(), sent.range_rate_m_s());
  }
  return finite;
}

wire::LidarScan ToWire(const LidarScan& scan) {
  wire::LidarScan sent;
  SetOrigin(scan, sent);
  for (std::size_t i = 0; i < kLidarBeams; ++i) {
    sent.echo()[i] = ToWireEnum<wire::EchoKind>(scan.echo[i]);
  }
  sent.range_m(scan.range_m);
  return sent;
}

bool FromWire(const wire::LidarScan& sample, LidarScan& scan) {
  GetOrigin(sample, scan);
  scan.range_m = sample.range_m();
  bool readable = true;
  for (std::size_t i = 0; i < kLidarBeams; ++i) {
    readable &= FromWirePart(sample.echo()[i], scan.echo[i]);
    readable &= std::isfinite(scan.range_m[i]);
  }
  return readable;
}

wire::CameraScan ToWire(const CameraScan& scan) {
  GIVEWAY_CHECK(scan.count <= kMaxDetections, scan.count);
  wire::CameraScan sent;
  SetOrigin(scan, sent);
  sent.objects().resize(scan.count);
  for (std::size_t i = 0; i < scan.count; ++i) {
    const CameraObject& object = scan.objects[i];
    wire::CameraObject& out = sent.objects()[i];
    out.seen_class(ToWireEnum<wire::SeenClass>(object.seen_class));
    out.bearing_rad(object.bearing_rad);
    out.half_width_rad(object.half_width_rad);
  }
  return sent;
}

bool FromWire(const wire::CameraScan& sample, CameraScan& scan) {
  GetOrigin(sample, scan);
  if (!GetCount(sample.objects(), scan.count)) return false;
  bool readable = true;
  for (std::size_t i = 0; i < scan.count; ++i) {
    const wire::CameraObject& sent = sample.objects()[i];
    CameraObject& object = scan.objects[i];
    object.bearing_rad = sent.bearing_rad();
    object.half_width_rad = sent.half_width_rad();
    readable &= FromWirePart(sent.seen_class(), object.seen_class);
    readable &= AreFinite(object.bearing_rad, object.half_width_rad);
  }
  return readable;
}

wire::SignalState ToWire(const SignalState& state) {
  wire::SignalState sent;
  sent.signal(Number(state.id));
  sent.world_epoch(Number(state.epoch));
  sent.tick(Number(state.tick));
  sent.line_from_x_m(state.line_from_world.x);
  sent.line_from_y_m(state.line_from_world.y);
  sent.line_to_x_m(state.line_to_world.x);
  sent.line_to_y_m(state.line_to_world.y);
  sent.travel_rad(state.travel_rad);
  sent.phase(ToWireEnum<wire::SignalPhase>(state.phase));
  sent.to_change_s(state.to_change_s);
  return sent;
}

bool FromWire(const wire::SignalState& sample, SignalState& state) {
  state.id = SignalId{sample.signal()};
  state.epoch = WorldEpoch{sample.world_epoch()};
  state.tick = Tick{sample.tick()};
  state.line_from_world = {sample.line_from_x_m(), sample.line_from_y_m()};
  state.line_to_world = {sample.line_to_x_m(), sample.line_to_y_m()};
  state.travel_rad = sample.travel_rad();
  state.to_change_s = sample.to_change_s();
  return FromWirePart(sample.phase(), state.phase) &&
         AreFinite(sample.line_from_x_m(), sample.line_from_y_m(), sample.line_to_x_m(),
                   sample.line_to_y_m(), state.travel_rad, state.to_change_s);
}

}  // namespace giveway::link
