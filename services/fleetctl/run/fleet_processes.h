// The processes of one run: the world and one process a vehicle. Starts, polls, kills and stops
// them; knows which deaths were planned. Hears nothing over DDS.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/run/run_options.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// What every process of a run is told.
struct FleetCommand {
  std::filesystem::path program_folder;  // giveway-world and giveway-vehicle are here
  std::string scenario_file;
  std::uint32_t domain = 0;
  std::string qos_file;
  int lock_fd = -1;         // inherited: the domain stays taken until the last process is gone
  bool flags_only = false;  // a measurement: no variable of the shell has a say
};

// How many vehicles the scenario does not name are to be started: 0 of a closed fleet.
std::uint32_t NewcomerCount(const RunOptions& options, const Scenario& scenario);
// The command lines: the world's first, then the named vehicles', then the others'. Pure; what the
// tests look at.
std::vector<ChildCommand> MakeCommands(const RunOptions& options, const FleetCommand& command,
                                       const Scenario& scenario);

// A line of a child's log that reports an error.
bool IsErrorLine(std::string_view line);

class FleetProcesses {
 public:
  FleetProcesses(const std::vector<ChildCommand>& commands, const Scenario& scenario);

  void Poll();
  // Carries out a planned fault.
  void Kill(VehicleId vehicle);

  ChildProcess& World() { return children_.front(); }
  // The first child whose end is the end of the run: in a closed fleet any that was not killed by
  // plan, in an open one the world, or a vehicle if none is left. nullptr if there is none.
  const ChildProcess* FirstUnplannedEnd() const;
  // What children that run, or ended well, reported as errors since the last call: of the others
  // the caller shows the last lines. Needs children that hand their lines on.
  std::vector<std::string> TakeErrors();
  // Vehicles of an open fleet that have ended since the last call.
  std::vector<const ChildProcess*> TakeNewlyEnded();
  // The first child that ended by a signal that was not planned, or a vehicle of a closed fleet
  // whose exit code is not 0 (the world's own code carries the verdict); nullptr if there is none.
  const ChildProcess* FirstBadEnd() const;
  bool AnyRunning() const;
  void AskAllToStop();
  void SignalAll(int signal_number);

 private:
  bool open_;
  std::deque<ChildProcess> children_;  // the world, then the vehicles in the scenario's order
  std::vector<VehicleId> vehicles_;
  std::set<const ChildProcess*> killed_;
  std::set<const ChildProcess*> told_ended_;
};

}  // namespace giveway::fleetctl
