// The result of a soak as values: what was run, which faults were injected, what was observed, and
// the verdict. The supervisor fills it; soak_json.h writes and reads it, soak_page.h shows it.
// Field names, units and meaning are those of idl/soak.proto. Lists hold at most kMostListed; the
// rest is counted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/statistics/slope.h"
#include "services/types/figures/histogram.h"
#include "services/types/ids.h"

namespace giveway::fleetctl {

// Limit for each list of a result, so that weeks fit into a page.
inline constexpr std::size_t kMostListed = 5000;
// With a larger share of pauses of the machine nothing is judged.
inline constexpr double kMostPausedShare = 0.02;
inline constexpr const char* kTooBusy = "machine_too_busy";  // the reason then

enum class SoakVerdict : std::uint8_t {
  kPassed,
  kFailed,
  kNotRun,       // "machine_too_busy" or another of the reasons
  kInterrupted,  // ended early, on request; no promise was broken before
};

struct SoakProgram {
  std::string name;      // "giveway-vehicle"
  std::string build_id;  // see program_id.h; empty: it has none
};

struct SoakVersions {
  std::vector<SoakProgram> programs;
  std::string fast_dds;  // "2.11.2"
  std::string kernel;    // as uname -r
  std::uint32_t host_cores = 0;
};

// Times count from the start signal. What has not happened is absent.
struct SoakFault {
  std::string rule;  // that planned it, and its index among the rule's faults, from 0
  std::uint32_t nth = 0;
  double at_s = 0;        // as planned; of the world's faults by its own time
  double for_s = 0;       // 0: instantaneous
  std::string kind;       // "pause"; see services/faults/fault.h
  std::string target;     // "vehicle 3", "world"
  bool observed = false;  // by its effect, not by the order given
  // "waitpid: signal 9"; of one not observed, why it had nothing to act on, or what kept it from
  // being judged; empty: nothing did
  std::string observed_how;
  std::optional<double> observed_s;       // when it started, by the time of violations
  std::optional<double> noticed_after_s;  // by peers, from its start
  std::optional<double> promised_s;       // to be noticed within
  std::optional<double>
      recovered_after_s;  // until every vehicle concerned drove again, from its end
};
// "burst#3", as violations name a fault.
std::string NameOf(const SoakFault& fault);
// By the clock of violations and modes: the world's time lags by as long as it was gone.
inline double StartOf(const SoakFault& fault) { return fault.observed_s.value_or(fault.at_s); }

struct SoakViolation {
  double time_s = 0;
  VehicleId vehicle = kNoVehicle;  // at fault, or first concerned
  VehicleId other = kNoVehicle;
  std::string invariant;  // "contact", or the promise: "detection", "recovery"
  std::string words;      // what was observed, as text
  std::string fault;      // NameOf the preceding fault; empty: none
};

// Two bodies, shell to shell, that came near each other, where the nearer one was.
struct NearMiss {
  double time_s = 0;
  VehicleId vehicle = kNoVehicle;
  VehicleId other = kNoVehicle;
  double x_m = 0;  // world
  double y_m = 0;
  double distance_m = 0;
};

// A vehicle's mode from then on: "drive", "halt", "gone" ...
struct ModeChange {
  double time_s = 0;
  VehicleId vehicle = kNoVehicle;
  std::string mode;
};

enum class HistogramUnit : std::uint8_t { kNanoseconds, kMicrometres, kPartsPerMillion };
// "ns", "um", "ppm", and the inverse.
const char* ToString(HistogramUnit unit);
std::optional<HistogramUnit> HistogramUnitOf(const std::string& word);

// At most `most`, in the histogram's unit, for the share `quantile` of all.
struct HistogramBudget {
  double quantile = 0.99;
  std::int64_t most = 0;
};

// The values of one block of time: soak_phases.h.
struct BlockSummary {
  std::uint64_t count = 0;
  std::int64_t mean = 0;  // 0 where nothing was counted
  std::int64_t p50 = 0;
  std::int64_t p99 = 0;

  friend constexpr bool operator==(const BlockSummary&, const BlockSummary&) = default;
};

struct SoakHistogram {
  std::string name;  // "reaction", "beacon_age", "tick_jitter"
  HistogramUnit unit = HistogramUnit::kNanoseconds;
  Histogram histogram;
  std::vector<HistogramBudget> budgets;
  std::vector<BlockSummary> blocks;  // from the first on; empty: not kept by block
};
// It was planned, and did not come: the soak ended before.
inline bool NeverStarted(const SoakFault& fault) { return !fault.observed && !fault.observed_s; }
// It was not observed, and its effect is not missing.
inline bool HadNothingToActOn(const SoakFault& fault) {
  return !fault.observed && !NeverStarted(fault) && !fault.observed_how.empty();
}
// It was carried out, and nothing says why it was not observed.
inline bool LacksEffect(const SoakFault& fault) {
  return !fault.observed && !NeverStarted(fault) && fault.observed_how.empty();
}
// All budgets are kept, or nothing was measured.
bool WithinBudgets(const SoakHistogram& measured);

enum class ResourceKind : std::uint8_t {
  kPrivateBytes,
  kHeapBytes,  // in use, as its allocator counts it
  kResidentBytes,
  kDescriptors,
  kThreads,
  kProcessors,  // processor time a second
  kSharedMemoryBytes,
};
inline constexpr std::size_t kResourceKinds = 7;
// "private_bytes", and the inverse.
const char* ToString(ResourceKind kind);
std::optional<ResourceKind> ResourceKindOf(const std::string& word);

// One resource of one life of one process: from a start to its end.
struct ResourceSlope {
  std::string process;     // "vehicle-3", "world"; "fleet" for what belongs to all
  std::uint32_t life = 0;  // counted from 0
  ResourceKind kind = ResourceKind::kPrivateBytes;
  statistics::Slope slope;  // without warm-up
  double last = 0;          // the figure at the life's end
  bool lasting = true;  // long enough to judge, and grew in each part: filling up does not count
  bool leak = false;
  std::vector<statistics::Sample>
      curve;  // of private bytes and heap: at most 60 points to draw; time of soak
};

// One writer as one reader accounts for it, all their lives added up.
struct AccountingRow {
  std::string writer;  // "vehicle 2"
  std::string reader;
  std::string topic;  // "fleet/beacon"
  std::uint64_t sent =
      0;  // by the writer's own numbers, from the first received to the last counted
  std::uint64_t accepted = 0;
  std::uint64_t not_heard = 0;   // stated from beyond the emission radius
  std::uint64_t refused = 0;     // arrived, and refused by a check
  std::uint64_t superseded = 0;  // arrived, and overwritten in the reader before it was taken
  std::uint64_t lost = 0;        // never arrived

  std::int64_t Difference() const {
    return static_cast<std::int64_t>(sent) -
           static_cast<std::int64_t>(accepted + not_heard + refused + superseded + lost);
  }
};

// Times at which the machine did not run our processes, so that lateness means nothing.
struct MachinePauses {
  std::uint64_t count = 0;
  double total_s = 0;
  double longest_s = 0;
  double share = 0;  // of the time judged, 0 to 1
};

// The reaction that left the least share of its free distance.
struct NarrowestMargin {
  double time_s = 0;  // at which it was reported
  VehicleId vehicle = kNoVehicle;
  double reaction_m = 0;  // driven from cause to wheels that obey
  double free_m = 0;      // that there was
  double share_left = 0;  // of free_m; alarm budget_spent below a fifth
};

// All vehicles were ordered to keep their recording rings, because an invariant was broken.
struct KeptRings {
  double time_s = 0;
  std::uint32_t ordered = 0;  // vehicles that were reached
  std::uint32_t kept = 0;     // of those, the ones that confirmed it
  std::string page;  // what the fleet did until then, a file in the report's folder; empty: none
};

struct SoakResult {
  SoakVerdict verdict = SoakVerdict::kNotRun;
  std::vector<std::string> reasons;  // one line each, the worst first

  std::string scenario;
  std::uint64_t seed = 0;
  double planned_s = 0;
  double ran_s = 0;  // from the start signal
  std::uint32_t vehicles = 0;
  std::uint32_t domain = 0;
  bool virtual_time = false;
  std::string faults_file;  // empty: none
  std::string qos_set;      // name or file
  std::string qos_hash;     // 16 hex digits
  SoakVersions versions;
  std::string command;  // that reproduces it

  std::vector<SoakFault> faults;      // by at_s
  std::uint64_t faults_counted = 0;   // including those not listed, and
  std::uint64_t faults_observed = 0;  // of them, those seen by their effect
  // What was left out, a line for each kind and reason; and the number of faults.
  std::vector<std::string> skipped_faults;
  std::uint64_t skipped_counted = 0;
  std::vector<SoakViolation> violations;  // by time_s
  std::uint64_t violations_counted = 0;   // including those not listed
  // Ticks in which every invariant was judged, and those of which too little was seen for that.
  std::uint64_t ticks_judged = 0;
  std::uint64_t ticks_unseen = 0;
  std::vector<NearMiss> near_misses;
  std::uint64_t near_misses_counted = 0;
  // Lengths of time for comparisons: soak_phases.h. 0: nothing is kept by block.
  double block_s = 0;
  std::vector<std::uint64_t> near_misses_by_block;   // up to the last with any
  std::vector<std::uint64_t> budget_spent_by_block;  // likewise
  std::vector<ModeChange> modes;
  std::uint64_t modes_counted = 0;

  std::vector<SoakHistogram> histograms;
  std::vector<ResourceSlope> slopes;
  std::uint64_t lives_too_short = 0;  // for a slope
  std::vector<AccountingRow> accounting;
  MachinePauses pauses;
  std::optional<NarrowestMargin> narrowest_margin;
  std::uint64_t budget_spent = 0;        // reactions that left less than a fifth
  std::uint64_t timing_values_lost = 0;  // missing from every received report
  std::vector<KeptRings> kept_rings;
  std::vector<double>
      resumed_at_s;  // the supervisor had died, and another fleet continued the soak
  std::uint32_t restarts_planned = 0;          // that were carried out
  std::uint32_t restarts_unplanned = 0;        // a process ended without a fault that explains it
  std::optional<double> supervisor_cpu_share;  // of the fleet's processor time
};

// 0 passed, 1 failed or interrupted, 2 not run.
int ExitCode(SoakVerdict verdict);
// "passed", "failed", "not_run", "interrupted".
const char* ToString(SoakVerdict verdict);

}  // namespace giveway::fleetctl
