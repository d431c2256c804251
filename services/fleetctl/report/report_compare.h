// What became worse from one soak to another, and whether chance explains it. Pure.
//
//   figures    histograms: as a whole (Mann-Whitney) and in the tail (the share above the 99 %
//              quantile of both, Fisher). Worse only if that quantile or the median grew by 5 %.
//   slopes     each resource of each process by its longest life: the difference against the
//              widths of both intervals. Worse only from the size of a leak on.
//   faults     by kind: time until noticed, until recovered (Mann-Whitney), from 5 % on; how
//              many were noticed late, how many had no effect (Fisher).
//   counts     violations by invariant, near misses, reactions that left less than a fifth of
//              their free distance, unplanned restarts over vehicle-hours (conditional
//              binomial).
//   verdict    one that no longer passes, samples that are not accounted for, new leaks: not
//              tested statistically.
//
// All tests together report two equal soaks as worse with a probability of at most 0.5 % (Holm at 1
// %, both directions); a single soak reports a false leak with a probability of 1 %. The values of
// a histogram are not independent: at most one per vehicle and second counts as evidence.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

inline constexpr double kSignificance = 0.01;

enum class Change : std::uint8_t { kSame, kBetter, kWorse };
const char* ToString(Change change);

struct ComparedFigure {
  std::string what;    // "beacon_age, tail"
  std::string before;  // with unit
  std::string after;
  Change change = Change::kSame;
  std::optional<double> p;  // adjusted; absent: no test was asked
};

struct SoakComparison {
  std::vector<ComparedFigure> figures;  // worse ones first, then better ones
  bool AnyWorse() const;
};

// Empty if the two can be compared, else all reasons why not: another scenario, other faults or
// numbers of vehicles, or one that was not run.
std::string WhyNotComparable(const SoakResult& before, const SoakResult& after);

SoakComparison Compare(const SoakResult& before, const SoakResult& after);

}  // namespace giveway::fleetctl
