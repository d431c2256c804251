#include "services/fleetctl/stopwatch/stopwatch_figures.h"

#include <algorithm>

namespace giveway::fleetctl {
namespace {

void Add(const Trial& trial, Cell* cell, std::vector<Nanoseconds>* times) {
  ++cell->trials;
  cell->asked += trial.watchers;
  for (const Sighting& sighting : trial.sightings) {
    if (sighting.mechanism != cell->mechanism) continue;
    times->push_back(sighting.after);
    if (cell->duty != Duty::kMust) continue;
    cell->longest_pause = std::max(cell->longest_pause, sighting.pause);
    if (sighting.after <= cell->promised) continue;
    const Nanoseconds excess = sighting.after - cell->promised - sighting.pause;
    if (excess <= Nanoseconds{0}) {
      ++cell->excused;
      continue;
    }
    ++cell->late;
    cell->worst_excess = std::max(cell->worst_excess, excess);
  }
}

Cell JudgeCell(std::span<const Trial> trials, Fault fault, Mechanism mechanism,
               const Limits& limits) {
  Cell cell{fault, mechanism, DutyOf(fault, mechanism, limits), PromisedWithin(mechanism, limits)};
  std::vector<Nanoseconds> times;
  for (const Trial& trial : trials) {
    if (trial.fault == fault) Add(trial, &cell, &times);
  }
  cell.seen = DistributionOf(std::move(times));
  if (cell.duty == Duty::kMust) cell.unseen = cell.asked - std::min(cell.asked, cell.seen.n);
  if (cell.duty == Duty::kNone) cell.uncalled_for = cell.seen.n;
  return cell;
}

}  // namespace

Distribution DistributionOf(std::vector<Nanoseconds> times) {
  if (times.empty()) return {};
  std::ranges::sort(times);
  const auto rank = [&](std::size_t percent) {
    return times[(times.size() * percent + 99) / 100 - 1];
  };
  return {static_cast<std::uint32_t>(times.size()), times.front(), rank(50), rank(99),
          times.back()};
}

std::vector<Cell> EvaluateTrials(std::span<const Trial> trials, const Limits& limits) {
  std::vector<Cell> cells;
  for (std::size_t f = 0; f < kFaults; ++f) {
    const auto fault = static_cast<Fault>(f);
    if (std::ranges::none_of(trials, [&](const Trial& trial) { return trial.fault == fault; })) {
      continue;
    }
    for (std::size_t m = 0; m < kMechanisms; ++m) {
      cells.push_back(JudgeCell(trials, fault, static_cast<Mechanism>(m), limits));
    }
  }
  return cells;
}

}  // namespace giveway::fleetctl
