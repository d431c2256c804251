// What one seed of `fleetctl virtual` means: the scenario and its faults.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/faults/fault_file.h"
#include "services/fleetctl/virtual/fleet_draw.h"
#include "services/types/math/random.h"
#include "services/types/scenario.h"
#include "sim_world/virtual/generators.h"
#include "sim_world/virtual/virtual_plan.h"

namespace giveway::fleetctl {

// Both ends included.
struct WholeRange {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
};
struct NumberRange {
  double low = 0;
  double high = 0;
};

// How long a scenario without an end is run.
inline constexpr double kEndless_s = 600;

// The operator's choice. From a range, each seed draws its own value.
struct CaseOptions {
  std::string scenario;                // a file, a shipped one, or a generator
  std::optional<WholeRange> vehicles;  // of a generator, or of an open fleet
  std::optional<Behaviour> behaviour;
  FleetChoice fleet;
  std::uint32_t also_required = 0;   // as of VirtualPlan
  std::optional<double> through_m;   // the same, of a file
  std::optional<double> duration_s;  // of a scenario; absent: its own, or kEndless_s
  NumberRange loss_percent;
  bool burst = false;  // the loss comes in bursts, the mean is the same
  double delay_ms = 0;
  double jitter_ms = 0;
  double reorder_percent = 0;
  double duplicate_percent = 0;
  bool loops_back = false;  // every vehicle receives its own beacons too
  WholeRange crashes;       // vehicles that die, pause, or restart, each at a random time
  WholeRange pauses;
  WholeRange restarts;
  std::vector<sim::ProcessFault> faults;  // in addition to drawn ones
  std::string fault_file;         // a file or a shipped one, in addition to the scenario's own list
  bool skip_unsupported = false;  // of both lists those that a virtual run cannot inject
  std::optional<std::uint32_t> radio_seed;   // absent: the seed
  std::optional<std::uint32_t> sensor_seed;  // of what wheels and sensors draw; absent: the seed
};

struct VirtualCase {
  Scenario scenario;
  sim::VirtualPlan plan;
};

class CaseMaker {
 public:
  // Throws InputError if the scenario is neither a file nor a generator, or has too few places, or
  // if a list of faults is invalid, or asks for what a virtual run cannot inject.
  explicit CaseMaker(const CaseOptions& options);

  // Throws InputError if a list of faults does not fit the vehicles that the seed drew.
  VirtualCase Make(std::uint32_t seed) const;
  const std::string& Name() const { return name_; }
  // The fault schedule of a seed, of the scenario's own list and the fault file.
  faults::Schedule ScheduleOf(const Scenario& scenario, std::uint32_t seed) const;
  bool HasFaults() const { return !sources_.empty(); }
  // True if the scenario states expectations: a file's does.
  bool HasExpectations() const { return loaded_.has_value(); }
  // A line about what of the scenario is left out; empty if nothing is.
  std::string Remark() const;

 private:
  void CheckVehicles() const;
  void CheckFleet() const;
  void TakeFaults(const std::optional<faults::FaultFile>& own);
  Scenario MakeScenario(std::uint32_t seed, Random* dice) const;

  CaseOptions options_;
  std::string name_;
  const sim::Generator* generator_ = nullptr;
  std::optional<Scenario> loaded_;  // with seed 0: as in the file
  std::vector<faults::FaultFile> sources_;
  faults::FaultFile rules_;  // of all sources
  std::string left_out_;     // what of them is left out, as text
};

}  // namespace giveway::fleetctl
