// The processes of one run: the world and one process a vehicle. Starts, polls, kills and stops
// them; knows which deaths were planned. Hears nothing over DDS.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/fleetctl/child_process.h"
#include "services/fleetctl/run.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// What every process of a run is told.
struct FleetCommand {
  std::filesystem::path program_folder;  // giveway-world and giveway-vehicle are here
  std::string scenario_file;
  std::uint32_t domain = 0;
  std::string qos_file;
  int lock_fd = -1;  // inherited: the domain stays taken until the last process is gone
};

// The command lines, the world's first. Pure; what the tests look at.
std::vector<ChildCommand> MakeCommands(const RunOptions& options, const FleetCommand& command,
                                       const Scenario& scenario);

class FleetProcesses {
 public:
  FleetProcesses(const std::vector<ChildCommand>& commands, const Scenario& scenario);

  void Poll();
  // Carries out a planned fault.
  void Kill(VehicleId vehicle);

  ChildProcess& World() { return children_.front(); }
  // The first child that has ended otherwise than by a planned kill; nullptr if there is none.
  const ChildProcess* FirstUnplannedEnd() const;
  // The first child that ended by a signal that was not planned, or a vehicle whose exit code is
  // not 0 (the world's own code carries the verdict); nullptr if there is none.
  const ChildProcess* FirstBadEnd() const;
  bool AnyRunning() const;
  void SignalAll(int signal_number);

 private:
  std::deque<ChildProcess> children_;  // the world, then the vehicles in the scenario's order
  std::vector<VehicleId> vehicles_;
  std::set<const ChildProcess*> killed_;
};

}  // namespace giveway::fleetctl
