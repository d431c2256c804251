// The world's writers for one vehicle: its ranges, and the further sensors it is fitted with. They
// end with this object.
#pragma once

#include <optional>

#include "services/link/participant.h"
#include "services/types/check.h"
#include "services/types/robot_model.h"

namespace giveway::link {

class VehicleWriters {
 public:
  VehicleWriters(Participant& participant, VehicleId vehicle, const RobotModel& profile);
  ~VehicleWriters();
  VehicleWriters(const VehicleWriters&) = delete;
  VehicleWriters& operator=(const VehicleWriters&) = delete;

  // False if the library refused the sample. The sensor must be fitted.
  bool Write(const wire::RangeScan& scan) { return ranges_.Write(scan); }
  bool Write(const wire::RadarScan& scan) { return Fitted(radar_).Write(scan); }
  bool Write(const wire::LidarScan& scan) { return Fitted(lidar_).Write(scan); }
  bool Write(const wire::CameraScan& scan) { return Fitted(camera_).Write(scan); }
  bool Write(const wire::PoseFix& fix) { return Fitted(pose_fix_).Write(fix); }

  // True if each of them has a reader.
  bool HaveReaders() const;

 private:
  template <typename Wire>
  static Writer<Wire>& Fitted(std::optional<Writer<Wire>>& writer) {
    GIVEWAY_CHECK(writer.has_value(), "a scan of a sensor that is not fitted");
    return *writer;
  }

  Participant& participant_;
  Writer<wire::RangeScan> ranges_;
  std::optional<Writer<wire::RadarScan>> radar_;
  std::optional<Writer<wire::LidarScan>> lidar_;
  std::optional<Writer<wire::CameraScan>> camera_;
  std::optional<Writer<wire::PoseFix>> pose_fix_;
};

}  // namespace giveway::link
