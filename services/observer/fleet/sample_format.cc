#include "services/observer/fleet/sample_format.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "services/runtime/json.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

// An enumerator this build does not know never comes this far: the link refuses it.
template <std::size_t kCount, typename Enumerator>
std::string_view NameOf(const std::array<std::string_view, kCount>& names, Enumerator value) {
  const auto index = static_cast<std::size_t>(value);
  return index < kCount ? names[index] : "unknown";
}

// "vehicle 2"; the reader's eye finds one vehicle's lines by it.
std::string Head(VehicleId vehicle) {
  return vehicle == kNoVehicle ? "world    " : fmt::format("vehicle {}", Number(vehicle));
}

std::string PoseText(const Pose& pose) {
  return fmt::format("at ({:.2f}, {:.2f}) m {:.0f} deg", pose.position_world.x,
                     pose.position_world.y, Degrees(pose.heading_rad));
}

// Text from the network, made harmless for a terminal; nothing where there is none.
std::string Quoted(const std::string& text) { return text.empty() ? "" : "  " + JsonText(text); }

std::string OptionalText(const char* name, const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("  {} {:.2f} {}", name, *value, unit) : "";
}

// Adds "3 missed (last 2)" to a list; nothing where nothing was counted.
void AddCount(const char* what, std::uint64_t count, std::uint32_t last, std::string* list) {
  if (count == 0) return;
  if (!list->empty()) *list += ", ";
  *list += fmt::format("{} {}", count, what);
  if (last != 0) *list += fmt::format(" (last {})", last);
}

}  // namespace

std::string_view Name(EventKind kind) {
  static constexpr std::array<std::string_view, 15> kNames = {
      "started", "halted", "went_on", "arrived", "contact", "closest",     "fault_due", "silent",
      "removed", "joined", "left",    "ended",   "verdict", "fault_began", "fault_over"};
  return NameOf(kNames, kind);
}

std::string_view Name(RunState state) {
  static constexpr std::array<std::string_view, 3> kNames = {"waiting", "running", "ended"};
  return NameOf(kNames, state);
}

std::string_view Name(SignalPhase phase) {
  static constexpr std::array<std::string_view, 4> kNames = {"dark", "red", "yellow", "green"};
  return NameOf(kNames, phase);
}

std::string SessionText(const SessionId& session) {
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", session[0], session[1], session[2], session[3]);
}

std::string ReasonText(const Decision& decision) {
  std::string reason(giveway::Name(decision.rule));
  if (decision.peer != kNoVehicle) reason += fmt::format(" {}", Number(decision.peer));
  return reason;
}

std::string EventsText(const VehicleStatus& status) {
  std::string list;
  AddCount("missed", status.qos.deadline_missed, Number(status.last_deadline_missed), &list);
  AddCount("lost", status.qos.liveliness_lost, Number(status.last_liveliness_lost), &list);
  AddCount("samples missing", status.beacons.lost, 0, &list);
  AddCount("incompatible", status.qos.incompatible_qos, 0, &list);
  AddCount("refused", status.beacons.Rejected(), status.last_rejected_id, &list);
  AddCount("do not fit", status.trust.Total(), 0, &list);
  AddCount("packets dropped", status.packets.Dropped(), 0, &list);
  if (!status.last_event) return list.empty() ? "-" : list;
  if (!list.empty()) list += "; ";
  list += fmt::format("last {}", giveway::Name(*status.last_event));
  if (status.last_event_about != kNoVehicle) {
    list += fmt::format(" {}", Number(status.last_event_about));
  }
  return list;
}

std::string ToLine(const ReceivedBeacon& received) {
  const Beacon& beacon = received.beacon;
  std::string line =
      fmt::format("{}  #{} tick {}  wheels {:.2f} {:.2f} rad/s  cruise {:.2f} m/s  {}  {} {}",
                  Head(beacon.vehicle), beacon.seq, Number(beacon.tick), beacon.wheels.left_rad_s,
                  beacon.wheels.right_rad_s, beacon.cruise_m_s, PoseText(beacon.world_from_body),
                  giveway::Name(beacon.mode), giveway::Name(beacon.rule));
  if (beacon.gives_way_to != kNoVehicle) {
    line += fmt::format("  gives way to {}", Number(beacon.gives_way_to));
  }
  if (beacon.blocked_by != kNoVehicle) {
    line += fmt::format("  blocked by {}", Number(beacon.blocked_by));
  }
  if (!received.crc_valid) line += "  CHECK SUM WRONG";
  if (!received.name_valid) line += "  NOT ITS WRITER'S ID";
  return line;
}

std::string ToLine(const VehicleStatus& status) {
  std::string line = fmt::format("{}  tick {}  {} {}  {:.2f} m/s", Head(status.vehicle),
                                 Number(status.tick), giveway::Name(status.decision.mode),
                                 ReasonText(status.decision), status.forward_m_s);
  line += OptionalText("echo", status.nearest_echo_m, "m");
  line += fmt::format("  peers {}  events {}", status.peers_heard, EventsText(status));
  return status.final ? line + "  last words" : line;
}

std::string ToLine(const Truth& truth) {
  std::string line =
      fmt::format("{}  tick {}  {:.2f} s  {}  {:.2f} m/s", Head(truth.vehicle), Number(truth.tick),
                  truth.time_s, PoseText(truth.world_from_body), truth.forward_m_s);
  if (truth.arrived) line += "  arrived";
  if (!truth.present) line += "  gone";
  return line;
}

std::string ToLine(const WorldEvent& event) {
  std::string line =
      fmt::format("{}  {:.2f} s  {}", Head(event.vehicle), event.time_s, Name(event.kind));
  if (event.other != kNoVehicle) line += fmt::format("  other {}", Number(event.other));
  if (event.value != 0) line += fmt::format("  {:.2f}", event.value);
  return line + Quoted(event.text);
}

std::string ToLine(const RosterEntry& entry) {
  const char* const answer = entry.accepted  ? "accepted"
                             : entry.waiting ? "has to wait"
                                             : "refused";
  return fmt::format("{}  {}  {}  world {} {}  {} vehicles  session {}{}", Head(entry.vehicle),
                     answer, PoseText(entry.start_world), Number(entry.epoch),
                     Name(entry.run_state), entry.fleet_size,
                     SessionText(entry.session).substr(0, 8), Quoted(entry.reason));
}

std::string ToLine(const SignalState& signal) {
  const std::string change =
      signal.to_change_s > 0 ? fmt::format(", changes in {:.1f} s", signal.to_change_s) : "";
  return fmt::format("signal {}  tick {}  {}{}", Number(signal.id), Number(signal.tick),
                     Name(signal.phase), change);
}

std::string ToLine(const RunFigures& figures) {
  std::string line =
      fmt::format("{}  {}{}  contacts {}", Head(kNoVehicle), figures.passed ? "passed" : "failed",
                  Quoted(figures.reason), figures.contacts);
  line += OptionalText("closest", figures.min_separation_m, "m");
  line += OptionalText("clear after", figures.time_to_clear_s, "s");
  line += OptionalText("reaction p99", figures.reaction_p99_ms, "ms");
  return line;
}

}  // namespace giveway
