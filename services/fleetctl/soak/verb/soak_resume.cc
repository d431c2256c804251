#include "services/fleetctl/soak/verb/soak_resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "services/config/problem.h"
#include "services/faults/kind_table.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

std::string FileIn(const std::string& folder) {
  return (std::filesystem::path(folder) / "so_far.json").string();
}

template <typename Item>
void Append(const std::vector<Item>& more, std::vector<Item>* items) {
  items->insert(items->end(), more.begin(), more.end());
}

// For lists of elements with a time.
template <typename Item>
void AppendLater(const std::vector<Item>& more, double by_s, std::vector<Item>* items) {
  for (Item item : more) {
    if (items->size() == kMostListed) return;
    item.time_s += by_s;
    items->push_back(std::move(item));
  }
}

void AppendSlopes(const std::vector<ResourceSlope>& more, double by_s,
                  std::vector<ResourceSlope>* slopes) {
  for (ResourceSlope row : more) {
    for (statistics::Sample& sample : row.curve) sample.time_s += by_s;
    slopes->push_back(std::move(row));
  }
}

bool IsOfWorld(const SoakFault& fault) {
  const std::optional<faults::Kind> kind = faults::KindOf(fault.kind);
  return kind && faults::ActorOf(*kind) == faults::Actor::kWorld;
}

void AppendFaults(const SoakResult& rest, double by_s, SoakResult* joined) {
  std::erase_if(joined->faults, [by_s](const SoakFault& fault) {
    return fault.at_s >= by_s || (NeverStarted(fault) && IsOfWorld(fault));  // which are left out
  });
  for (SoakFault& fault : joined->faults) {
    const bool unknown = NeverStarted(fault) && fault.observed_how.empty();
    if (unknown) fault.observed_how = "active as the soak died: not judged";
  }
  for (SoakFault fault : rest.faults) {
    fault.at_s += by_s;
    if (fault.observed_s) *fault.observed_s += by_s;
    joined->faults.push_back(std::move(fault));
  }
}

void JoinHistograms(const SoakResult& rest, SoakResult* joined) {
  for (const SoakHistogram& more : rest.histograms) {
    const auto found = std::ranges::find(joined->histograms, more.name, &SoakHistogram::name);
    if (found == joined->histograms.end()) {
      joined->histograms.push_back(more);
    } else {
      found->histogram.Merge(more.histogram);
    }
  }
}

// Those of the two legs are of different lengths, and say nothing side by side.
void DropBlocks(SoakResult* joined) {
  joined->block_s = 0;
  joined->near_misses_by_block.clear();
  joined->budget_spent_by_block.clear();
  for (SoakHistogram& measured : joined->histograms) measured.blocks.clear();
}

// Each leg's share counts for as long as it ran.
void JoinSupervisor(const SoakResult& rest, double by_s, SoakResult* joined) {
  std::optional<double>& share = joined->supervisor_cpu_share;
  if (!rest.supervisor_cpu_share) return;
  share = share ? (*share * by_s + *rest.supervisor_cpu_share * rest.ran_s) /
                      std::max(1.0, by_s + rest.ran_s)
                : rest.supervisor_cpu_share;
}

void JoinCounts(const SoakResult& rest, double by_s, SoakResult* joined) {
  joined->violations_counted += rest.violations_counted;
  joined->ticks_judged += rest.ticks_judged;
  joined->ticks_unseen += rest.ticks_unseen;
  joined->faults_observed += rest.faults_observed;
  joined->restarts_planned += rest.restarts_planned;
  // The first leg had them all; what is left out since does not come.
  const std::uint64_t planned = std::max(joined->faults_counted, rest.skipped_counted);
  joined->faults_counted =
      std::max<std::uint64_t>(joined->faults.size(), planned - rest.skipped_counted);
  joined->near_misses_counted += rest.near_misses_counted;
  joined->modes_counted += rest.modes_counted;
  joined->lives_too_short += rest.lives_too_short;
  joined->budget_spent += rest.budget_spent;
  joined->timing_values_lost += rest.timing_values_lost;
  joined->restarts_unplanned += rest.restarts_unplanned;
  const double paused_s = joined->pauses.total_s + rest.pauses.total_s;
  joined->pauses = {joined->pauses.count + rest.pauses.count, paused_s,
                    std::max(joined->pauses.longest_s, rest.pauses.longest_s),
                    paused_s / std::max(1.0, by_s + rest.ran_s)};
  if (!rest.narrowest_margin) return;
  NarrowestMargin margin = *rest.narrowest_margin;
  margin.time_s += by_s;
  const bool narrower =
      !joined->narrowest_margin || margin.share_left < joined->narrowest_margin->share_left;
  if (narrower) joined->narrowest_margin = margin;
}

bool WasTooBusy(const SoakResult& result) {
  return result.verdict == SoakVerdict::kNotRun && result.pauses.share > kMostPausedShare;
}

// The verdict of the rest, except that a promise that was broken before stays broken, and that the
// machine's pauses are those of both.
void JoinVerdicts(const SoakResult& rest, SoakResult* joined) {
  const bool ended_early = joined->ran_s < joined->planned_s;
  joined->verdict = !WasTooBusy(rest) ? rest.verdict
                    : ended_early     ? SoakVerdict::kInterrupted
                                      : SoakVerdict::kPassed;
  const bool not_run = joined->verdict == SoakVerdict::kNotRun;
  std::map<std::string, std::uint64_t> by_kind;
  for (const SoakViolation& broken : joined->violations) ++by_kind[broken.invariant];
  joined->reasons.clear();
  if (not_run) joined->reasons = rest.reasons;
  for (const auto& [kind, count] : by_kind) {
    joined->reasons.push_back(fmt::format("{}: {}", kind, count));
  }
  if (joined->violations_counted > 0 && !not_run) joined->verdict = SoakVerdict::kFailed;
  if (joined->pauses.share > kMostPausedShare && !not_run) {
    joined->verdict = SoakVerdict::kNotRun;
    joined->reasons.insert(joined->reasons.begin(), kTooBusy);
  }
  for (const double at_s : joined->resumed_at_s) {
    joined->reasons.push_back(fmt::format("resumed at {:.0f} s", at_s));
  }
}

}  // namespace

std::string SaveSoFar(const std::string& so_far, const std::string& folder) {
  return WriteStateFile(FileIn(folder), so_far);
}

void ForgetSoFar(const std::string& folder) {
  std::error_code error;
  std::filesystem::remove(FileIn(folder), error);
}

void ForgetSoak(const std::string& folder) {
  ForgetSoFar(folder);
  for (const char* const file : {kCheckpointFile, "report.json", "report.html"}) {
    std::error_code error;
    std::filesystem::remove(std::filesystem::path(folder) / file, error);
  }
}

SoakResult LoadSoFar(const std::string& folder) {
  ReadSoak read = ReadSoakReport(FileIn(folder));
  if (read.complaint.empty()) return std::move(read.result);
  throw InputError({{.file = folder,
                     .field = "--resume",
                     .value = folder,
                     .message = "holds no soak to resume: " + read.complaint,
                     .remedy = "one that reached its verdict is finished: see report.json there; "
                               "one that died before its fleet drove must be started again"}});
}

faults::Schedule RestOf(const faults::Schedule& whole, const SoakResult& so_far, double warm_up_s,
                        SkippedFaults* lost) {
  const double from_s = so_far.ran_s;
  std::set<std::pair<std::string, std::uint32_t>> awaited;
  for (const SoakFault& fault : so_far.faults) {
    if (NeverStarted(fault) && IsOfWorld(fault)) awaited.insert({fault.rule, fault.nth});
  }
  faults::Schedule rest;
  for (const faults::Fault& fault : whole) {
    if (fault.at_s < from_s) {
      if (!awaited.contains({fault.rule, fault.nth})) continue;
      lost->Add(fault, "had not come as the soak died: the world's time lagged");
      continue;
    }
    if (fault.at_s - from_s < warm_up_s) {
      lost->Add(fault, "fell into the start of the resumed fleet");
      continue;
    }
    rest.push_back(fault);
    rest.back().at_s -= from_s;
  }
  return rest;
}

SoakResult Joined(const SoakResult& so_far, const SoakResult& rest) {
  SoakResult joined = so_far;
  const double by_s = so_far.ran_s;
  joined.ran_s = by_s + rest.ran_s;
  joined.domain = rest.domain;
  joined.versions = rest.versions;
  joined.resumed_at_s.push_back(by_s);
  AppendFaults(rest, by_s, &joined);
  Append(rest.skipped_faults, &joined.skipped_faults);
  joined.skipped_counted += rest.skipped_counted;
  AppendLater(rest.violations, by_s, &joined.violations);
  AppendLater(rest.near_misses, by_s, &joined.near_misses);
  AppendLater(rest.modes, by_s, &joined.modes);
  AppendLater(rest.kept_rings, by_s, &joined.kept_rings);
  AppendSlopes(rest.slopes, by_s, &joined.slopes);
  Append(rest.accounting, &joined.accounting);
  JoinHistograms(rest, &joined);
  DropBlocks(&joined);
  JoinCounts(rest, by_s, &joined);
  JoinSupervisor(rest, by_s, &joined);
  JoinVerdicts(rest, &joined);
  return joined;
}

}  // namespace giveway::fleetctl
