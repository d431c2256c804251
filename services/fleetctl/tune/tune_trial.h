// One trial: a world and a fleet of vehicles as processes, in a domain of their own, with one set
// of QoS profiles. Waits until all receive all, observes them for a while, kills one after another,
// stops the rest, and reads their recordings. Several may run in parallel: each cycle is short.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/process/fleet_processes.h"
#include "services/fleetctl/tune/tune_evidence.h"
#include "services/fleetctl/tune/tune_reading.h"
#include "services/link/observer_link.h"
#include "services/types/math/random.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// What all trials of a search share.
struct TuneGround {
  FleetSpec fleet;  // except the trial's own domain, QoS, seed and recordings
  const Scenario* scenario = nullptr;
  std::string observer_qos;  // the base's: the library keeps one set per process
  double alive_s = 10;
};

struct TrialOrder {
  std::string candidate;
  std::string qos_file;
  bool verification = false;
  std::uint32_t trial = 0;
  std::uint32_t seed = 0;
  std::filesystem::path folder;  // of its own, for recordings; removed at the end
};

class TuneTrial {
 public:
  // Starts everything. Throws LinkError, StartError, DomainError.
  TuneTrial(const TuneGround& ground, const TrialOrder& order);
  ~TuneTrial();
  TuneTrial(const TuneTrial&) = delete;
  TuneTrial& operator=(const TuneTrial&) = delete;

  void Turn(SteadyTime now);
  bool IsOver() const { return phase_ == Phase::kOver; }
  const TrialOrder& Order() const { return order_; }
  // When it is over.
  TrialEvidence TakeEvidence();

 private:
  enum class Phase : std::uint8_t { kStarting, kSettling, kAlive, kKilling, kStopping, kOver };

  void Enter(Phase phase, SteadyTime until) {
    phase_ = phase;
    until_ = until;
  }
  void Fail(const std::string& why);
  void Hear();
  bool AllHearAll() const;
  void CheckAlive();
  void BeginAlive(SteadyTime now);
  void EndAlive(SteadyTime now);
  void PlanKillings();
  void KillIfDue(SteadyTime now);
  void Stop(SteadyTime now);
  void StopFurther(SteadyTime now);
  double CpuSeconds() const;
  std::optional<double> HeardBytesPerSecond() const;

  const TuneGround& ground_;
  TrialOrder order_;
  DomainLock lock_;
  Random random_;
  std::optional<link::ObserverLink> observer_;
  std::optional<FleetProcesses> processes_;
  Phase phase_ = Phase::kStarting;
  SteadyTime until_{0};
  SteadyTime begun_{0};
  std::map<VehicleId, bool> hears_all_;
  AliveWindow window_;
  double cpu_before_s_ = 0;
  double cpu_used_s_ = 0;
  struct PlannedKilling {
    VehicleId target = kNoVehicle;
    Nanoseconds after{0};  // the last one
  };
  std::vector<PlannedKilling> planned_;
  std::vector<Killing> killed_;
  SteadyTime stopped_{0};
  std::string trouble_;
};

// A place where no vehicles meet: as many lanes as vehicles, 3 m apart, all within reach of each
// other.
std::string TuneScenarioText(std::uint32_t vehicles);

}  // namespace giveway::fleetctl
