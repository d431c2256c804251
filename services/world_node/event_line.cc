#include "services/world_node/event_line.h"

namespace giveway {
namespace {

std::string IdText(VehicleId vehicle) { return std::to_string(Number(vehicle)); }

std::string TouchedText(const WorldEvent& event) {
  if (event.other != kNoVehicle) return "vehicle " + IdText(event.other);
  if (event.text.empty()) return "something";
  return (event.text == "obstacle" ? "an " : "a ") + event.text;
}

// What a planned fault concerns: a signal, or else a vehicle.
std::string DueText(const WorldEvent& event) {
  if (event.vehicle != kNoVehicle) return event.text + " of vehicle " + IdText(event.vehicle);
  return event.text + " of signal " + std::to_string(static_cast<std::uint32_t>(event.value));
}

std::string ScheduledText(const WorldEvent& event) {
  return event.text + (event.vehicle == kNoVehicle ? ", of all vehicles"
                                                   : ", of vehicle " + IdText(event.vehicle));
}

}  // namespace

std::string LogLine(const WorldEvent& event) {
  switch (event.kind) {
    case EventKind::kContact:
      return "contact: vehicle " + IdText(event.vehicle) + " touched " + TouchedText(event);
    case EventKind::kFaultDue:
      return "fault due: " + DueText(event);
    case EventKind::kFaultBegan:
      return "fault starts: " + ScheduledText(event);
    case EventKind::kFaultOver:
      return "fault is over: " + ScheduledText(event);
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
