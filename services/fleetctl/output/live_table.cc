#include "services/fleetctl/output/live_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/observer/fleet/sample_format.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kRowFormat = "{:>7}  {:<11}  {:<14}  {:>9}  {:>6}  {:>5}  {}";

std::string QosText(const VehicleStatus& status) {
  const QosCounters& qos = status.qos;
  std::string text = fmt::format("{} missed, {} lost", qos.deadline_missed, qos.liveliness_lost);
  if (qos.incompatible_qos > 0) text += fmt::format(", {} incompatible", qos.incompatible_qos);
  if (status.beacons.Rejected() > 0) text += fmt::format(", {} refused", status.beacons.Rejected());
  if (status.trust.Total() > 0) text += fmt::format(", {} do not fit", status.trust.Total());
  return text;
}

std::string Row(VehicleId vehicle, const TableView& view) {
  const auto found = view.statuses.find(vehicle);
  if (view.silent.contains(vehicle)) {
    const std::string events = found == view.statuses.end() ? "-" : QosText(found->second);
    return fmt::format(kRowFormat, Number(vehicle), "silent", "-", "-", "-", "-", events);
  }
  if (found == view.statuses.end()) {
    return fmt::format(kRowFormat, Number(vehicle), "-", "not heard yet", "-", "-", "-", "-");
  }
  const VehicleStatus& status = found->second;
  const std::string echo =
      status.nearest_echo_m ? fmt::format("{:.2f}", *status.nearest_echo_m) : "-";
  return fmt::format(kRowFormat, Number(vehicle), Name(status.decision.mode),
                     ReasonText(status.decision), fmt::format("{:.2f}", status.forward_m_s), echo,
                     status.peers_heard, QosText(status));
}

std::string Title(const TableView& view) {
  const std::string end =
      view.duration_s > 0 ? fmt::format("of at most {:.0f} s", view.duration_s) : "until stopped";
  return fmt::format("{}  domain {}  {}  {:.1f} s {}", view.scenario, view.domain, view.state,
                     view.time_s, end);
}

}  // namespace

std::vector<std::string> FitTerminal(std::vector<std::string> lines,
                                     const std::vector<std::string>& rows, TerminalSize size) {
  // The last row stays free: a line feed there would scroll the screen.
  const std::size_t room = static_cast<std::size_t>(std::max(size.rows - 1, 0));
  const std::size_t left = room > lines.size() ? room - lines.size() : 0;
  const std::size_t total = rows.size();
  const std::size_t shown = total <= left ? total : (left > 0 ? left - 1 : 0);
  lines.insert(lines.end(), rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(shown));
  if (shown < total) lines.push_back(fmt::format("{:>7}  and {} more", "...", total - shown));
  if (lines.size() > room) lines.resize(room);
  const auto columns = static_cast<std::size_t>(std::max(size.columns, 0));
  for (std::string& line : lines) {
    if (line.size() > columns) line.resize(columns);
  }
  return lines;
}

std::vector<std::string> TableLines(const TableView& view, TerminalSize size) {
  std::vector<std::string> rows;
  for (const VehicleId vehicle : view.vehicles) rows.push_back(Row(vehicle, view));
  return FitTerminal({Title(view), fmt::format(kRowFormat, "vehicle", "mode", "reason", "speed m/s",
                                               "echo m", "peers", "QoS events")},
                     rows, size);
}

std::string ProgressLine(const TableView& view) {
  std::string line =
      fmt::format("{}: {} of {} vehicles", Title(view), view.statuses.size(), view.vehicles.size());
  for (const auto& [vehicle, status] : view.statuses) {
    if (view.silent.contains(vehicle) || !IsGiveWay(status.decision.rule)) continue;
    line += fmt::format(", {} {}", Number(vehicle), ReasonText(status.decision));
  }
  return line;
}

}  // namespace giveway::fleetctl
