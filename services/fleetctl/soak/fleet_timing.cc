#include "services/fleetctl/soak/fleet_timing.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace giveway::fleetctl {
namespace {

constexpr std::int64_t kNanosecondsPerUs = 1000;
constexpr double kPartsPerMillion = 1e6;

HistogramUnit UnitOf(DriveFigure figure) {
  switch (figure) {
    case DriveFigure::kReactionDistance:
      return HistogramUnit::kMicrometres;
    case DriveFigure::kReactionShare:
      return HistogramUnit::kPartsPerMillion;
    default:
      return HistogramUnit::kNanoseconds;
  }
}

BlockSummary SummaryOf(const Histogram& histogram) {
  return {histogram.Count(), std::llround(histogram.Mean()), histogram.Quantile(0.5),
          histogram.Quantile(0.99)};
}

}  // namespace

Nanoseconds MostBeaconAge(const Scenario& scenario) {
  Nanoseconds limit{0};
  for (const auto& vehicle : scenario.vehicles) limit = std::max(limit, vehicle.beacon_age_limit);
  for (const auto& spawn : scenario.spawns) limit = std::max(limit, spawn.beacon_age_limit);
  return limit + scenario.tick_period;
}

void FleetTiming::Fold(const VehicleStatus& status, double time_s) {
  EndBlocksBefore(time_s);
  DriveFigures& before = before_[status.vehicle];
  const DriveFigures& now = status.timing;
  const bool restarted = now.Of(DriveFigure::kTurn).count < before.Of(DriveFigure::kTurn).count ||
                         now.budget_spent < before.budget_spent;
  if (restarted) before = {};
  for (std::size_t i = 0; i < kDriveFigures; ++i) TakeNewest(status, i, time_s);
  budget_spent_ += now.budget_spent - before.budget_spent;
  spent_by_block_.Note(time_s, now.budget_spent - before.budget_spent);
  if (now.narrowest && now.narrowest != before.narrowest &&
      (!narrowest_ || now.narrowest->ShareLeft() < narrowest_->share_left)) {
    narrowest_ = {time_s, status.vehicle, now.narrowest->reaction_m, now.narrowest->free_m,
                  now.narrowest->ShareLeft()};
  }
  before = now;
}

void FleetTiming::EndBlocksBefore(double time_s) {
  for (const std::size_t now = BlockOf(time_s, block_s_); block_ < now; ++block_) {
    for (std::size_t i = 0; i < kDriveFigures; ++i) {
      ended_[i].push_back(SummaryOf(fresh_[i]));
      fresh_[i] = {};
    }
  }
}

std::vector<BlockSummary> FleetTiming::BlocksOf(std::size_t figure) const {
  if (!(block_s_ > 0)) return {};
  std::vector<BlockSummary> blocks = ended_[figure];
  blocks.push_back(SummaryOf(fresh_[figure]));
  return blocks;
}

// At fast ticks some values are the newest in no report. The largest of them is known all the same.
void FleetTiming::TakeNewest(const VehicleStatus& status, std::size_t figure, double time_s) {
  const FigureSummary& now = status.timing.figures[figure];
  const FigureSummary& before = before_[status.vehicle].figures[figure];
  if (now.count <= before.count) return;
  constexpr auto kKept = static_cast<std::uint32_t>(FigureSummary::kNewest);
  const std::uint32_t reported = std::min(now.count - before.count, kKept);
  std::uint32_t missed = now.count - before.count - reported;
  std::uint32_t largest = before.max;
  const auto take = [&](std::uint32_t value) {
    largest = std::max(largest, value);
    Take(status.vehicle, static_cast<DriveFigure>(figure), value, time_s);
  };
  for (std::uint32_t n = now.count - reported; n != now.count; ++n) take(now.newest[n % kKept]);
  if (missed > 0 && now.max > largest) {
    take(now.max);
    --missed;
  }
  missed_ += missed;
}

void FleetTiming::Take(VehicleId vehicle, DriveFigure figure, std::uint32_t value, double time_s) {
  const bool is_time = UnitOf(figure) == HistogramUnit::kNanoseconds;
  const std::int64_t counted = is_time ? kNanosecondsPerUs * value : std::int64_t{value};
  histograms_[static_cast<std::size_t>(figure)].Add(counted);
  if (block_s_ > 0) fresh_[static_cast<std::size_t>(figure)].Add(counted);
  if (figure != DriveFigure::kBeaconAge || Nanoseconds(counted) <= most_age_) return;
  StaleDecisions& stale = stale_[vehicle];
  if (stale.count++ == 0) stale.first_s = time_s;
  stale.oldest = std::max(stale.oldest, Nanoseconds(counted));
}

std::vector<SoakHistogram> FleetTiming::Histograms() const {
  std::vector<SoakHistogram> all;
  for (std::size_t i = 0; i < kDriveFigures; ++i) {
    if (histograms_[i].Count() == 0) continue;
    const auto figure = static_cast<DriveFigure>(i);
    SoakHistogram measured{
        .name = std::string(Name(figure)), .unit = UnitOf(figure), .histogram = histograms_[i]};
    if (figure == DriveFigure::kBeaconAge) {
      measured.budgets.push_back({1.0, most_age_.count()});
    } else if (figure == DriveFigure::kReactionShare) {
      measured.budgets.push_back(
          {1.0, static_cast<std::int64_t>((1 - kLeastShareLeft) * kPartsPerMillion)});
    }
    measured.blocks = BlocksOf(i);
    all.push_back(std::move(measured));
  }
  return all;
}

}  // namespace giveway::fleetctl
