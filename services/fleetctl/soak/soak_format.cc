#include "services/fleetctl/soak/soak_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "services/fleetctl/soak/resource_series.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kNoValue = "-";

std::string FormatMargin(const SoakResult& result) {
  if (!result.narrowest_margin) return "not measured";
  const NarrowestMargin& margin = *result.narrowest_margin;
  return fmt::format(
      "{:.0f} % left: vehicle {} drove {:.2f} m of {:.2f} m free, at {:.1f} s; {} left less than a "
      "fifth",
      margin.share_left * 100, Number(margin.vehicle), margin.reaction_m, margin.free_m,
      margin.time_s, result.budget_spent);
}

std::string FormatAccounting(const SoakResult& result) {
  if (result.accounting.empty()) return "not kept";
  const AccountingSums all = SumsOf(result.accounting);
  return fmt::format(
      "{} sent = {} accepted + {} not heard + {} refused + {} superseded + {} lost; {} of {} pairs "
      "differ",
      all.sums.sent, all.sums.accepted, all.sums.not_heard, all.sums.refused, all.sums.superseded,
      all.sums.lost, all.rows_that_differ, all.rows);
}

std::string FormatVersion(const SoakVersions& versions) {
  const auto known = [](const std::string& text) { return text.empty() ? "unknown" : text; };
  std::string text;
  for (const SoakProgram& program : versions.programs) {
    text += fmt::format("{} {}, ", program.name, known(program.build_id.substr(0, 12)));
  }
  return text + fmt::format("Fast DDS {}, kernel {}, {} cores", known(versions.fast_dds),
                            known(versions.kernel), versions.host_cores);
}

std::string FormatFaults(const SoakResult& result) {
  const auto observed = std::ranges::count(result.faults, true, &SoakFault::observed);
  std::string text = fmt::format(
      "{} of {} seen by their effect, {} skipped",
      std::max<std::uint64_t>(result.faults_observed, static_cast<std::uint64_t>(observed)),
      std::max<std::uint64_t>(result.faults_counted, result.faults.size()), result.skipped_counted);
  const auto idle = std::ranges::count_if(result.faults, HadNothingToActOn);
  if (idle > 0) text += fmt::format(", {} had nothing to act on", idle);
  const auto never = std::ranges::count_if(result.faults, NeverStarted);
  if (never > 0) text += fmt::format(", {} not started", never);
  if (result.faults_counted > result.faults.size()) {
    text += fmt::format("; the first {} by kind:", result.faults.size());
  }
  return text;
}

std::string FormatViolations(const SoakResult& result) {
  std::string text = fmt::format("{}", result.violations_counted);
  const std::uint64_t ticks = result.ticks_judged + result.ticks_unseen;
  if (ticks == 0) return text;
  return text +
         fmt::format("; every invariant judged in {} of {} ticks", result.ticks_judged, ticks);
}

std::string SlopeSummary(const SoakResult& result) {
  std::string leaks;
  std::size_t count = 0;
  for (const ResourceSlope& row : result.slopes) {
    if (!row.leak) continue;
    if (++count > 3) continue;
    leaks += fmt::format("{}{} {} {}/h", leaks.empty() ? "" : "; ", row.process, ToString(row.kind),
                         FormatResource(row.kind, row.slope.per_hour));
  }
  const auto judged = std::ranges::count_if(result.slopes, [](const ResourceSlope& row) {
    return row.slope.spans_s >= kLeastLeakSpan_s;
  });
  std::string text = count == 0
                         ? fmt::format("no leak in {} slopes", judged)
                         : fmt::format("{} of {} slopes are leaks: {}", count, judged, leaks);
  if (result.lives_too_short > 0) {
    text += fmt::format("; {} lives too short to judge", result.lives_too_short);
  }
  return text;
}

// A report may be read from a file, and a link there could lead anywhere.
std::string LinkTo(const std::string& page) {
  return page.starts_with("recordings/") ? page : std::string();
}

}  // namespace

std::string FormatVerdict(const SoakResult& result) {
  std::string word = "NOT RUN";
  if (result.verdict == SoakVerdict::kPassed) word = "PASSED";
  if (result.verdict == SoakVerdict::kFailed) word = "FAILED";
  if (result.verdict == SoakVerdict::kInterrupted) word = "INTERRUPTED";
  if (result.reasons.empty()) return word;
  return fmt::format("{}: {}", word, fmt::join(result.reasons, "; "));
}

std::string FormatSpan(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0) return kNoValue;
  const auto whole = static_cast<std::uint64_t>(std::min(std::round(seconds), 1e12));
  if (whole < 120) return fmt::format("{} s", whole);
  if (whole < 7200) return fmt::format("{} min {} s", whole / 60, whole % 60);
  if (whole < 2ULL * 86400) return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
  return fmt::format("{} d {} h", whole / 86400, whole / 3600 % 24);
}

std::string FormatSeconds(const std::optional<double>& seconds) {
  if (!seconds || !std::isfinite(*seconds)) return kNoValue;
  return fmt::format("{:.3f} s", *seconds);
}

std::string FormatValue(HistogramUnit unit, std::int64_t value) {
  const double shown = static_cast<double>(value) * 1e-6;
  if (unit == HistogramUnit::kMicrometres) return fmt::format("{:.3f} m", shown);
  if (unit == HistogramUnit::kPartsPerMillion) return fmt::format("{:.1f} %", shown * 100);
  return shown < 10 ? fmt::format("{:.3f} ms", shown) : fmt::format("{:.1f} ms", shown);
}

std::vector<std::string> FormatBudgets(const SoakHistogram& measured) {
  std::vector<std::string> words;
  for (const HistogramBudget& budget : measured.budgets) {
    const bool kept = measured.histogram.Count() == 0 ||
                      measured.histogram.Quantile(budget.quantile) <= budget.most;
    words.push_back(fmt::format("{:g} % at most {}: {}", budget.quantile * 100,
                                FormatValue(measured.unit, budget.most),
                                kept ? "kept" : "EXCEEDED"));
  }
  return words;
}

std::string FormatResource(ResourceKind kind, double value) {
  if (!std::isfinite(value)) return kNoValue;
  switch (kind) {
    case ResourceKind::kDescriptors:
    case ResourceKind::kThreads:
      return fmt::format("{:.1f}", value);
    case ResourceKind::kProcessors:
      return fmt::format("{:.3f}", value);
    default:
      break;
  }
  constexpr double kMiB = 1048576;
  return std::abs(value) < kMiB ? fmt::format("{:.1f} KiB", value / 1024)
                                : fmt::format("{:.2f} MiB", value / kMiB);
}

std::vector<FaultSummary> SummariesOf(const std::vector<SoakFault>& faults) {
  std::map<std::string, FaultSummary> by_kind;
  for (const SoakFault& fault : faults) {
    FaultSummary& summary = by_kind[fault.kind];
    ++summary.planned;
    if (fault.observed) ++summary.observed;
    if (LacksEffect(fault)) ++summary.missing;
    if (fault.noticed_after_s) summary.noticed_s.push_back(*fault.noticed_after_s);
    if (fault.recovered_after_s) summary.recovered_s.push_back(*fault.recovered_after_s);
    if (fault.noticed_after_s && fault.promised_s && *fault.noticed_after_s > *fault.promised_s) {
      ++summary.late;
    }
  }
  std::vector<FaultSummary> summaries;
  for (auto& [kind, summary] : by_kind) {
    summary.kind = kind;
    std::ranges::sort(summary.noticed_s);
    std::ranges::sort(summary.recovered_s);
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

std::optional<double> MedianOf(const std::vector<double>& ascending) {
  if (ascending.empty()) return std::nullopt;
  return ascending[ascending.size() / 2];
}

std::optional<double> GreatestOf(const std::vector<double>& ascending) {
  if (ascending.empty()) return std::nullopt;
  return ascending.back();
}

AccountingSums SumsOf(const std::vector<AccountingRow>& rows) {
  AccountingSums all;
  all.rows = rows.size();
  for (const AccountingRow& row : rows) {
    all.sums.sent += row.sent;
    all.sums.accepted += row.accepted;
    all.sums.not_heard += row.not_heard;
    all.sums.refused += row.refused;
    all.sums.superseded += row.superseded;
    all.sums.lost += row.lost;
    if (row.Difference() != 0) ++all.rows_that_differ;
  }
  return all;
}

std::vector<SummaryRow> SummaryOf(const SoakResult& result) {
  std::vector<SummaryRow> rows{
      {"ran", fmt::format("{} of {}, {} vehicles, domain {}, seed {}{}", FormatSpan(result.ran_s),
                          FormatSpan(result.planned_s), result.vehicles, result.domain, result.seed,
                          result.virtual_time ? ", virtual time" : "")},
      {"faults", FormatFaults(result)},
      {"violations", FormatViolations(result)},
      {"near misses", fmt::format("{}", result.near_misses_counted)},
      {"narrowest margin", FormatMargin(result)},
      {"slopes", SlopeSummary(result)},
      {"accounting", FormatAccounting(result)},
      {"restarts",
       fmt::format("{} planned, {} not", result.restarts_planned, result.restarts_unplanned)},
      {"machine's pauses",
       fmt::format("{}, {:.2f} % of the time, the longest {:.3f} s", result.pauses.count,
                   result.pauses.share * 100, result.pauses.longest_s)}};
  if (result.timing_values_lost > 0) {
    rows.push_back({"values lost", fmt::format("{} of the figures, which no received report has",
                                               result.timing_values_lost)});
  }
  for (const KeptRings& kept : result.kept_rings) {
    rows.push_back({"rings kept", fmt::format("at {:.1f} s, by {} of {} vehicles", kept.time_s,
                                              kept.kept, result.vehicles)});
    if (!kept.page.empty()) rows.push_back({"black box", kept.page, LinkTo(kept.page)});
  }
  if (result.supervisor_cpu_share) {
    rows.push_back({"supervisor", fmt::format("{:.1f} % of the fleet's processor time",
                                              *result.supervisor_cpu_share * 100)});
  }
  rows.push_back({"QoS", fmt::format("{} {}", result.qos_set, result.qos_hash)});
  rows.push_back({"versions", FormatVersion(result.versions)});
  rows.push_back({"again", result.command});
  return rows;
}

}  // namespace giveway::fleetctl
