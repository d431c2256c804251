#include "services/observer/fleet/fleet_view.h"

#include <algorithm>

namespace giveway {
namespace {

constexpr std::size_t kMostSignals = 256;

}  // namespace

void FigureHistogram::Fold(const FigureSummary& summary) {
  if (summary.count < seen_) seen_ = 0;
  const std::uint32_t fresh =
      std::min<std::uint32_t>(summary.count - seen_, FigureSummary::kNewest);
  for (std::uint32_t n = summary.count - fresh; n < summary.count; ++n) {
    const std::uint32_t value = summary.newest[n % FigureSummary::kNewest];
    const auto* const bucket = std::ranges::lower_bound(kLimits_us, value);
    ++counts_[static_cast<std::size_t>(bucket - kLimits_us.begin())];
    ++values_;
    sum_us_ += value;
    newest_us_ = value;
  }
  seen_ = summary.count;
}

const VehicleView* FleetView::Find(VehicleId vehicle) const {
  const auto found = vehicles_.find(vehicle);
  return found == vehicles_.end() ? nullptr : &found->second;
}

// What an earlier world said of bodies and signals no longer holds.
void FleetView::FoldWorld(WorldEpoch epoch) {
  if (epoch == epoch_) return;
  epoch_ = epoch;
  for (auto& [id, vehicle] : vehicles_) {
    vehicle.truth.reset();
    vehicle.ranges.reset();
  }
  signals_.clear();
  figures_.reset();
}

void FleetView::Fold(const link::Observed& observed, SteadyTime now) {
  heard_.Fold(observed, now);
  for (const Truth& truth : observed.truths) {
    FoldWorld(truth.epoch);
    vehicles_[truth.vehicle].truth = truth;
  }
  for (const RangeScan& scan : observed.ranges) {
    if (scan.epoch != epoch_ && epoch_ != kNoEpoch) continue;
    VehicleView& vehicle = vehicles_[scan.vehicle];
    vehicle.ranges = scan;
    vehicle.ranges_at = now;
  }
  for (const VehicleStatus& status : observed.statuses) {
    VehicleView& vehicle = vehicles_[status.vehicle];
    vehicle.beacon_age.Fold(status.timing.Of(DriveFigure::kBeaconAge));
    vehicle.reaction.Fold(status.timing.Of(DriveFigure::kReaction));
  }
  for (const SignalState& signal : observed.signals) {
    if (signals_.size() < kMostSignals || signals_.contains(signal.id)) {
      signals_[signal.id] = signal;
    }
  }
  for (const WorldEvent& event : observed.events) events_.push_back(event);
  event_count_ += observed.events.size();
  while (events_.size() > kMostEvents) events_.pop_front();
  if (observed.figures) figures_ = observed.figures;
  std::erase_if(vehicles_,
                [this](const auto& entry) { return !heard_.Vehicles().contains(entry.first); });
}

}  // namespace giveway
