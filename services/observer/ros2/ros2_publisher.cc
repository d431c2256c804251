#include "services/observer/ros2/ros2_publisher.h"

#include <utility>

#include "services/observer/ros2/ros2_samples.h"
#include "services/ros2/conversion.h"

namespace giveway {

Ros2Publisher::Ros2Publisher(const link::LinkOptions& options, double rate_hz,
                             ros2::View::ProfileOf profile)
    : view_(rate_hz, std::move(profile)), link_(options) {}

void Ros2Publisher::Publish(const link::Observed& observed, std::uint64_t now_ns) {
  Feed(observed, {now_ns, now_ns}, &view_);
  const ros2::Batch batch = view_.Collect(now_ns);
  for (const ros2::Message& message : batch.messages) {
    ++(link_.Write(message) ? written_ : refused_);
  }
  for (const VehicleId vehicle : batch.gone) link_.Close(ros2::Namespace(vehicle));
}

}  // namespace giveway
