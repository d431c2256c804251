#include "services/world_node/event_line.h"

namespace giveway {
namespace {

std::string IdText(VehicleId vehicle) { return std::to_string(Number(vehicle)); }

}  // namespace

std::string LogLine(const WorldEvent& event) {
  switch (event.kind) {
    case EventKind::kContact:
      return "contact: vehicle " + IdText(event.vehicle) + " touched " +
             (event.other == kNoVehicle ? "something" : "vehicle " + IdText(event.other));
    case EventKind::kFaultDue:
      return "fault due: " + event.text;
    case EventKind::kFaultBegan:
      return "fault starts: " + event.text;
    case EventKind::kFaultOver:
      return "fault is over: " + event.text;
    case EventKind::kSilent:
      return "vehicle " + IdText(event.vehicle) + " fell silent";
    case EventKind::kRemoved:
      return "vehicle " + IdText(event.vehicle) + " was silent for long: its body is taken away";
    case EventKind::kJoined:
      return "vehicle " + IdText(event.vehicle) + " joined the run";
    case EventKind::kLeft:
      return "vehicle " + IdText(event.vehicle) + " left the run";
    default:
      return {};
  }
}

}  // namespace giveway
