// The processes of one stopwatch fleet on a domain of its own: a world and the vehicles. Starts,
// strikes, restarts and ends them, and reads what they say. Judges nothing.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/stopwatch/stopwatch_plan.h"
#include "services/fleetctl/stopwatch/stopwatch_words.h"

namespace giveway::fleetctl {

// What every fleet of a stopwatch is started with.
struct StopwatchFleetCommand {
  std::filesystem::path program_folder;
  std::string scenario_file;
  std::string qos_file;
  std::string interface;
  std::string logs_folder;  // of this fleet; empty: no logs are kept
};

// One vehicle's word.
struct Said {
  VehicleId by = kNobody;
  Word word;
};

class StopwatchFleet {
 public:
  // `impair` is what each hearer is told with --impair. Lives on one thread, which must outlive it:
  // the processes end when the thread that started them does. Throws StartError, DomainError.
  StopwatchFleet(const StopwatchFleetCommand& command, std::span<const VehicleId> fleet,
                 const std::map<VehicleId, std::string>& impair);
  // Ends whoever is left, in good order if they do it within two seconds.
  ~StopwatchFleet();
  StopwatchFleet(const StopwatchFleet&) = delete;
  StopwatchFleet& operator=(const StopwatchFleet&) = delete;

  // Sleeps for a moment and takes in what was said.
  void Turn();
  const PeersHeard& WhoHears() const { return hearing_; }
  // Since the last ForgetSaid, vehicle by vehicle in its order.
  const std::vector<Said>& Heard() const { return said_; }
  void ForgetSaid() { said_.clear(); }
  // When a vehicle began to count its blackouts.
  std::optional<SteadyTime> BlackoutsSince(VehicleId vehicle) const;

  void Signal(VehicleId vehicle, int signal_number);
  bool IsRunning(VehicleId vehicle) const { return vehicles_.at(vehicle).process->IsRunning(); }
  // A new process for a vehicle whose last one has ended.
  void Restart(VehicleId vehicle);
  // In words, if somebody ended who is not in `struck`.
  std::optional<std::string> Loss(std::span<const VehicleId> struck) const;

 private:
  struct Vehicle {
    ChildCommand command;
    std::unique_ptr<ChildProcess> process;
  };

  void Poll();
  bool AnyRunning() const;

  DomainLock lock_;
  std::unique_ptr<ChildProcess> world_;
  std::map<VehicleId, Vehicle> vehicles_;
  std::map<VehicleId, SteadyTime> blackouts_since_;
  PeersHeard hearing_;
  std::vector<Said> said_;
};

}  // namespace giveway::fleetctl
