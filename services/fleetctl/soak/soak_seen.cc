#include "services/fleetctl/soak/soak_seen.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kLingers = std::chrono::seconds(10);

}  // namespace

std::optional<std::size_t> FaultBehind(std::span<const faults::Fault> schedule,
                                       std::span<const FaultCourse> courses, VehicleId vehicle,
                                       SteadyTime at) {
  std::optional<std::size_t> struck_it;
  std::optional<std::size_t> any;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const FaultCourse& course = courses[i];
    if (!course.began || *course.began > at) continue;
    if (course.ended && at > *course.ended + kLingers) continue;
    any = i;
    const faults::Target& target = schedule[i].target;
    const bool everyone = target.what != faults::Target::What::kVehicle;
    if (everyone || target.vehicle == vehicle) struck_it = i;
  }
  return struck_it ? struck_it : any;
}

}  // namespace giveway::fleetctl
