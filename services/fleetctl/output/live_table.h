// The one-screen table of a running fleet as lines of text. Pure: takes what is known and the size
// of the terminal, returns lines that fit it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "services/runtime/terminal_size.h"
#include "services/types/fleet_facts.h"

namespace giveway::fleetctl {

struct TableView {
  std::string scenario;
  std::uint32_t domain = 0;
  std::string state;                // "waiting", "running", "stopping"
  double time_s = 0;                // since the start signal
  double duration_s = 0;            // 0: until stopped
  std::vector<VehicleId> vehicles;  // all that the scenario names, heard or not
  std::map<VehicleId, VehicleStatus> statuses;
  std::set<VehicleId> silent;  // their last status is history, not state
};

// The head and as many of the rows as fit: at most size.rows - 1 lines, each at most size.columns
// bytes. Rows that do not fit are counted in the last line.
std::vector<std::string> FitTerminal(std::vector<std::string> head,
                                     const std::vector<std::string>& rows, TerminalSize size);
// The table, ASCII, so fitted.
std::vector<std::string> TableLines(const TableView& view, TerminalSize size);
// The same in one line, for a log: time, vehicles heard, which of them give way.
std::string ProgressLine(const TableView& view);

}  // namespace giveway::fleetctl
