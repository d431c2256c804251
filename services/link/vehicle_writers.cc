#include "services/link/vehicle_writers.h"

namespace giveway::link {
namespace {

template <typename Wire>
std::optional<Writer<Wire>> MakeWriterIf(bool fitted, Participant& participant, VehicleId vehicle) {
  if (!fitted) return std::nullopt;
  return participant.MakeWriter<Wire>(VehiclePartition(vehicle));
}

template <typename Wire>
bool HasReader(const std::optional<Writer<Wire>>& writer) {
  return !writer.has_value() || writer->HasReader();
}

}  // namespace

VehicleWriters::VehicleWriters(Participant& participant, VehicleId vehicle,
                               const RobotModel& profile)
    : participant_(participant),
      ranges_(participant.MakeWriter<wire::RangeScan>(VehiclePartition(vehicle))),
      radar_(MakeWriterIf<wire::RadarScan>(profile.radar, participant, vehicle)),
      lidar_(MakeWriterIf<wire::LidarScan>(profile.lidar, participant, vehicle)),
      camera_(MakeWriterIf<wire::CameraScan>(profile.camera, participant, vehicle)),
      pose_fix_(MakeWriterIf<wire::PoseFix>(profile.pose_fix.Fitted(), participant, vehicle)) {}

VehicleWriters::~VehicleWriters() {
  participant_.Delete(ranges_.Entity());
  if (radar_) participant_.Delete(radar_->Entity());
  if (lidar_) participant_.Delete(lidar_->Entity());
  if (camera_) participant_.Delete(camera_->Entity());
  if (pose_fix_) participant_.Delete(pose_fix_->Entity());
}

bool VehicleWriters::HaveReaders() const {
  return ranges_.HasReader() && HasReader(radar_) && HasReader(lidar_) && HasReader(camera_) &&
         HasReader(pose_fix_);
}

}  // namespace giveway::link
