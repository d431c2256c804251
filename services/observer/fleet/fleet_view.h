// All an observer shows of a fleet: the newest of each vehicle and of the world, the last events,
// and what the vehicles' own figures of timeliness add up to. Bounded; pure: the time is an
// argument.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "services/observer/fleet/fleet_snapshot.h"
#include "services/types/figures/drive_figures.h"
#include "services/types/range_scan.h"

namespace giveway {

// A figure of fleet/status counted into buckets, as Prometheus does: a report carries the newest 16
// values, so that one missed report in three loses none.
class FigureHistogram {
 public:
  static constexpr std::array<std::uint32_t, 10> kLimits_us{
      10'000, 20'000, 50'000, 75'000, 100'000, 150'000, 200'000, 300'000, 500'000, 1'000'000};

  // The values that came since the last summary; of a process that started again, all.
  void Fold(const FigureSummary& summary);
  // Values up to kLimits_us[bucket]; not cumulative.
  std::uint64_t Count(std::size_t bucket) const { return counts_[bucket]; }
  std::uint64_t Above() const { return counts_.back(); }
  std::uint64_t Values() const { return values_; }
  double Sum_us() const { return sum_us_; }
  std::optional<std::uint32_t> Newest_us() const { return newest_us_; }

 private:
  std::uint32_t seen_ = 0;
  std::array<std::uint64_t, kLimits_us.size() + 1> counts_{};
  std::uint64_t values_ = 0;
  double sum_us_ = 0;
  std::optional<std::uint32_t> newest_us_;
};

struct VehicleView {
  std::optional<Truth> truth;  // of the world that is there now
  // Null once the world has taken the body out.
  const Truth* Body() const { return truth && truth->present ? &*truth : nullptr; }
  // True: it is nowhere, whatever its last beacon says.
  bool IsTakenOut() const { return truth && !truth->present; }
  std::optional<RangeScan> ranges;
  SteadyTime ranges_at{0};
  FigureHistogram beacon_age;
  FigureHistogram reaction;
};

class FleetView {
 public:
  static constexpr std::size_t kMostEvents = 512;

  void Fold(const link::Observed& observed, SteadyTime now);

  const FleetSnapshot& Heard() const { return heard_; }
  // Null for a vehicle of which only beacons came.
  const VehicleView* Find(VehicleId vehicle) const;
  const std::map<SignalId, SignalState>& Signals() const { return signals_; }
  // The newest, in order; an epoch's numbers start again with the next world.
  const std::deque<WorldEvent>& Events() const { return events_; }
  std::uint64_t EventCount() const { return event_count_; }  // all that came, also those gone
  const std::optional<RunFigures>& Figures() const { return figures_; }

 private:
  void FoldWorld(WorldEpoch epoch);

  FleetSnapshot heard_;
  std::map<VehicleId, VehicleView> vehicles_;
  std::map<SignalId, SignalState> signals_;
  std::deque<WorldEvent> events_;
  std::uint64_t event_count_ = 0;
  std::optional<RunFigures> figures_;
  WorldEpoch epoch_ = kNoEpoch;
};

}  // namespace giveway
