// From a fault file to the concrete list that real and virtual runs carry out. Decides times and
// targets, refuses what cannot be, and knows nothing of how they are carried out. Pure: the same
// file, seed, duration and vehicles give the same list bit for bit on every machine.
//
// Each draw is a hash of seed, name of the rule and count, so taking one rule out moves no other's
// faults. Of two that exclude each other the later one is dropped, and that of a random rule for
// that of an `at` rule; it is dropped even for one that is dropped itself, so that taking a rule
// out never takes a fault out of another either.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/faults/fault_file.h"

namespace giveway::faults {

// Of a run, what a list of faults depends on.
struct Course {
  std::uint32_t seed = 0;
  double duration_s = 60;  // since the start signal
  double warm_up_s = 10;   // before it no random fault starts
  double healing_s = 15;   // at the end: every fault is over before it
};

// Of a soak. Discovery takes a few seconds, and longer with more vehicles; healing must cover the
// vehicle that restarted last, and its slowest right of way.
inline double WarmUpOfSoak_s(double duration_s, std::size_t vehicles) {
  return std::min(duration_s / 4, 10 + 0.5 * static_cast<double>(vehicles));
}
inline double HealingOfSoak_s(double duration_s) { return std::min(duration_s / 4, 20.0); }

// Of a run without phases of its own. A list without anything random is taken unchanged, however
// long the run: also the rest of a longer one.
Course CourseOfRun(const FaultFile& file, double duration_s, std::uint32_t seed);

// Why a file cannot be carried out with this fleet and course.
struct Refusal {
  std::string rule;
  int line = 0;         // of the rule
  std::string field;    // such as "target"; empty: the rule as a whole
  std::string message;  // what is wrong
  std::string remedy;
  std::string other = {};  // of two that exclude each other: the other's rule
};

// Faults of a random rule that were drawn and are not in the list.
struct LeftOut {
  std::string rule;
  std::uint32_t excluded = 0;  // by another fault on the same target at the same time
  std::uint32_t too_late = 0;  // would not have ended before the healing
};

struct Expansion {
  Schedule schedule;
  std::vector<Refusal> refused;   // not empty: the schedule must not be used
  std::vector<LeftOut> left_out;  // of rules with any, in the order of the file
};

// More faults than that are refused: `everything` draws half a million in 30 days.
inline constexpr std::size_t kMostFaults = 1000000;

Expansion Expand(const FaultFile& file, const Course& course, std::span<const VehicleId> vehicles);

// The list as a fault file of its own: expanded again it is the same.
FaultFile AsFile(const Schedule& schedule);

}  // namespace giveway::faults
