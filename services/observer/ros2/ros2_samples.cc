#include "services/observer/ros2/ros2_samples.h"

#include <utility>

#include "services/link/ros2/ros2_link.h"
#include "services/link/sample_codec.h"
#include "services/ros2/definitions.h"

namespace giveway {

void Feed(const link::Observed& observed, ros2::Times at, ros2::View* view) {
  for (const ReceivedBeacon& received : observed.beacons) {
    if (received.crc_valid && received.name_valid) view->Take(received.beacon, at);
  }
  for (const RangeScan& scan : observed.ranges) view->Take(scan, at);
  for (const MotorCommand& command : observed.commands) view->Take(command, at);
}

Ros2Samples::Ros2Samples(double rate_hz)
    : view_(rate_hz, [](VehicleId) { return PioneerP3dx(); }) {}

std::vector<Ros2Sample> Ros2Samples::Take(const link::RawSample& sample) {
  link::Observed observed;
  link::DecodeInto(link::RawTopics().at(sample.topic).name, sample.bytes, &observed);
  Feed(observed, {sample.source_ns, sample.reception_ns}, &view_);
  std::vector<Ros2Sample> samples;
  for (const ros2::Message& message : view_.Collect(sample.reception_ns).messages) {
    samples.push_back({message.topic, ros2::TypeOf(message.body), sample.reception_ns,
                       message.stamp_ns, link::Encode(message)});
  }
  return samples;
}

}  // namespace giveway
