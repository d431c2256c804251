// The Pareto front of the candidates, and the recommended one. Pure.
//
// The rule of the recommendation: of the candidates that have fewer false alarms than the base,
// beyond what chance explains, and notice a dead vehicle no later than it, those that notice it
// first; of these the one with the fewest false alarms, then the least bandwidth, then the least
// CPU. If there is none, the one with the fewest false alarms of all.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "services/fleetctl/tune/tune_evidence.h"

namespace giveway::fleetctl {

// Detection times closer than this are equal: a vehicle decides once a tick, and acts on an event
// between two ticks in the second.
inline constexpr double kSameDetectionMs = 12.5;  // a quarter of a tick of 50 ms

// However few readings there are, a larger difference than this is later: a loop cycle is 50.
inline constexpr double kMostChanceMs = 20;

// Places of those that no other dominates: none has fewer false alarms and notices as early, or
// notices earlier with as few. By rising detection time.
std::vector<std::size_t> ParetoFront(const std::vector<TuneFigures>& figures);

// All places, the most promising first: the front, the front of the rest, and so on; in each by
// rising number of false alarms.
std::vector<std::size_t> Ranking(const std::vector<TuneFigures>& figures);

// True if the rates differ by more than two standard errors.
bool HasFewerAlarms(const TuneFigures& one, const TuneFigures& than);
// True unless its mean is later by more than two standard errors, within the two bounds above.
bool NoticesNoLater(const TuneFigures& one, const TuneFigures& than);

// The place of the recommended one; figures[base] is the base's.
std::size_t Recommended(const std::vector<TuneFigures>& figures, std::size_t base);

}  // namespace giveway::fleetctl
