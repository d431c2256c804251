// One stopwatch fleet in its own domain: its processes, and what its vehicles report. Judges
// nothing.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/process/fleet_processes.h"
#include "services/fleetctl/stopwatch/stopwatch_log_events.h"

namespace giveway::fleetctl {

// One report of a vehicle.
struct VehicleLogEvent {
  VehicleId by = kNoVehicle;
  LogEvent event;
};

class StopwatchFleet {
 public:
  // `spec` except the domain; `impair` is the --impair of each hearer. Use on one thread: see
  // FleetProcesses. Throws StartError, DomainError.
  StopwatchFleet(const FleetSpec& spec, const std::map<VehicleId, std::string>& impair);
  // Ends the remaining processes, gracefully if they manage within two seconds.
  ~StopwatchFleet();
  StopwatchFleet(const StopwatchFleet&) = delete;
  StopwatchFleet& operator=(const StopwatchFleet&) = delete;

  // Sleeps for a moment and takes the reports.
  void Turn();
  const PeersHeard& WhoHears() const { return hearing_; }
  // Logged since the last ForgetEvents, vehicle by vehicle, each in order.
  const std::vector<VehicleLogEvent>& Heard() const { return events_; }
  void ForgetEvents() { events_.clear(); }
  // When a vehicle started to count its blackouts.
  std::optional<SteadyTime> BlackoutsSince(VehicleId vehicle) const;

  void Signal(VehicleId vehicle, int signal_number) {
    processes_.Signal(MemberOf(vehicle), signal_number);
  }
  bool IsRunning(VehicleId vehicle) const { return processes_.IsRunning(MemberOf(vehicle)); }
  // A new process for a vehicle whose last one has ended.
  void Restart(VehicleId vehicle);
  // A message if a process ended that no fault of the wave targets.
  std::optional<std::string> Loss(std::span<const VehicleId> injected) const;

 private:
  DomainLock lock_;
  FleetProcesses processes_;
  std::map<VehicleId, SteadyTime> blackouts_since_;
  PeersHeard hearing_;
  std::vector<VehicleLogEvent> events_;
};

}  // namespace giveway::fleetctl
