// How timely a whole fleet was, from its vehicles' own reports: the sum over all reported values of
// all lives. Bounded. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/soak_result.h"
#include "services/types/figures/drive_figures.h"
#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

// The oldest beacon that any decision may use: the highest limit of any vehicle, plus the one tick
// by which every decision lags.
Nanoseconds MostBeaconAge(const Scenario& scenario);

// A vehicle decided on beacons that were too old.
struct StaleDecisions {
  double first_s = 0;  // first reported, since the start signal
  Nanoseconds oldest{0};
  std::uint64_t count = 0;
};

class FleetTiming {
 public:
  // The oldest beacon, since its tick, that may be used for a decision.
  // Without `block_s` nothing is kept by block.
  explicit FleetTiming(Nanoseconds most_age, double block_s = 0)
      : most_age_(most_age), block_s_(block_s), spent_by_block_(block_s) {}

  // `time_s` since the start signal. Lives of a vehicle follow each other: if its counts fall, it
  // has restarted. Blocks end as time passes: it must not fall.
  void Fold(const VehicleStatus& status, double time_s);

  // The figures with values, with their budgets, in the order of DriveFigure.
  std::vector<SoakHistogram> Histograms() const;
  std::optional<NarrowestMargin> Narrowest() const { return narrowest_; }
  std::uint64_t BudgetSpent() const { return budget_spent_; }
  double BlockLength_s() const { return block_s_; }
  const std::vector<std::uint64_t>& BudgetSpentByBlock() const { return spent_by_block_.Counts(); }
  // Values that no report has: reports were lost, ticks are fast, or a process died before its next
  // one.
  std::uint64_t Missed() const { return missed_; }
  const std::map<VehicleId, StaleDecisions>& Stale() const { return stale_; }

 private:
  void Take(VehicleId vehicle, DriveFigure figure, std::uint32_t value, double time_s);
  void EndBlocksBefore(double time_s);
  std::vector<BlockSummary> BlocksOf(std::size_t figure) const;
  void TakeNewest(const VehicleStatus& status, std::size_t figure, double time_s);

  Nanoseconds most_age_;
  double block_s_;
  BlockCounts spent_by_block_;
  std::size_t block_ = 0;                       // the current one, and
  std::array<Histogram, kDriveFigures> fresh_;  // its values
  std::array<std::vector<BlockSummary>, kDriveFigures> ended_;
  std::array<Histogram, kDriveFigures> histograms_;
  std::map<VehicleId, DriveFigures> before_;
  std::map<VehicleId, StaleDecisions> stale_;
  std::optional<NarrowestMargin> narrowest_;
  std::uint64_t budget_spent_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace giveway::fleetctl
