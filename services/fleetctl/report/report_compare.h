// What became worse from one soak to another, and whether chance explains it. Pure.
//
// A soak's values come in clusters: many vehicles meet one burst of loss, and all heal from one
// fault. What counts as independent is a block of time (soak_phases.h), a twentieth of the run,
// never a value. Two soaks of one duration are compared block by block, so that warm-up meets
// warm-up:
//
//   figures    histograms: mean, median and 99 % of each block (signed ranks, SeriesGreater).
//              Worse only if that of the whole run grew by 5 %.
//   counts     violations by invariant, near misses, reactions that left less than a fifth of their
//              free distance: the counts of each block, likewise.
//   faults     by kind: time until noticed, until recovered (Mann-Whitney), from 5 % on; how many
//              were noticed late, how many had no effect (Fisher). Those of one kind in one block
//              come to one value.
//   slopes     each resource of each process by its longest life: the difference against the
//              widths of both intervals. Worse only from the size of a leak on, and only of lives
//              that are long enough for a leak, and about as long as each other.
//   verdict    one that no longer passes, samples that are not accounted for, new leaks: not
//              tested statistically.
//   untested   shown where they differ, with the reason: values of one event (healing), other
//              durations or lives, reports without blocks. Of faults that are not all listed also
//              where the listed ones are alike.
//
// All tests together call the second of two soaks of equal programs worse once in 200 times at most
// (Holm at 1 %, both directions), if blocks are independent: measured in the README. Neighbours
// that resemble each other count for fewer; what differs for all of a run, such as a busier
// machine, is a difference. A single soak reports a false leak with a probability of 1 %.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

inline constexpr double kSignificance = 0.01;

enum class Change : std::uint8_t { kSame, kBetter, kWorse, kUntested };
const char* ToString(Change change);

struct ComparedFigure {
  std::string what;    // "beacon_age, tail"
  std::string before;  // with unit
  std::string after;
  Change change = Change::kSame;
  std::optional<double> p;   // adjusted; absent: no test was made
  std::string why_untested;  // empty: it was, or needs no test
};

struct SoakComparison {
  std::vector<ComparedFigure> figures;  // worse ones first, then better, then untested ones
  bool AnyWorse() const;
};

// Empty if the two can be compared, else all reasons why not: another scenario, other faults or
// numbers of vehicles, or one that was not run.
std::string WhyNotComparable(const SoakResult& before, const SoakResult& after);

SoakComparison Compare(const SoakResult& before, const SoakResult& after);

}  // namespace giveway::fleetctl
