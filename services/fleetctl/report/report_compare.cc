#include "services/fleetctl/report/report_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "services/fleetctl/soak/soak_format.h"
#include "services/statistics/distributions.h"
#include "services/statistics/two_sample.h"

namespace giveway::fleetctl {
namespace {

constexpr double kLeastChange = 0.05;                     // of a time; less does not matter
constexpr double kIntervalWidth = 2 * 1.959963984540054;  // of 95 %, in standard deviations

// A figure with the p values of both directions, before correction for multiple tests.
struct TestedFigure {
  ComparedFigure figure;
  double p_worse = 1;
  double p_better = 1;
  bool may_be_worse = true;  // by its size
  bool may_be_better = true;
};

class Figures {
 public:
  void Add(TestedFigure tested) { tested_.push_back(std::move(tested)); }
  void AddSure(std::string what, std::string before, std::string after, Change change) {
    sure_.push_back({std::move(what), std::move(before), std::move(after), change, std::nullopt});
  }

  std::vector<ComparedFigure> Judged() && {
    std::vector<double> p_values;
    for (const TestedFigure& tested : tested_) {
      p_values.push_back(std::min(1.0, 2 * std::min(tested.p_worse, tested.p_better)));
    }
    const std::vector<double> adjusted = statistics::HolmAdjusted(p_values);
    std::vector<ComparedFigure> figures = std::move(sure_);
    for (std::size_t i = 0; i < tested_.size(); ++i) {
      ComparedFigure& figure = tested_[i].figure;
      figure.p = adjusted[i];
      const bool upwards = tested_[i].p_worse < tested_[i].p_better;
      if (adjusted[i] < kSignificance) {
        if (upwards && tested_[i].may_be_worse) figure.change = Change::kWorse;
        if (!upwards && tested_[i].may_be_better) figure.change = Change::kBetter;
      }
      figures.push_back(std::move(figure));
    }
    const auto place = [](const ComparedFigure& figure) {
      return figure.change == Change::kWorse ? 0 : figure.change == Change::kBetter ? 1 : 2;
    };
    std::ranges::stable_sort(figures, {}, place);
    return figures;
  }

 private:
  std::vector<ComparedFigure> sure_;
  std::vector<TestedFigure> tested_;
};

bool GrewEnough(double before, double after) { return after > before * (1 + kLeastChange); }

// Vehicle-seconds.
double ExposureOf(const SoakResult& result) {
  return std::max(1.0, result.ran_s * std::max(1U, result.vehicles));
}

void CompareQuantile(const SoakHistogram& before, const SoakHistogram& after, double p,
                     std::string_view part, double p_worse, double p_better, Figures* figures) {
  const std::int64_t was = before.histogram.Quantile(p);
  const std::int64_t is = after.histogram.Quantile(p);
  const auto number = [](std::int64_t value) { return static_cast<double>(value); };
  figures->Add({.figure = {.what = fmt::format("{}, {}", before.name, part),
                           .before = FormatValue(before.unit, was),
                           .after = FormatValue(after.unit, is)},
                .p_worse = p_worse,
                .p_better = p_better,
                .may_be_worse = GrewEnough(number(was), number(is)),
                .may_be_better = GrewEnough(number(is), number(was))});
}

void CompareHistograms(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const double most_before = ExposureOf(before);
  const double most_after = ExposureOf(after);
  for (const SoakHistogram& was : before.histograms) {
    const auto is = std::ranges::find(after.histograms, was.name, &SoakHistogram::name);
    if (is == after.histograms.end() || is->unit != was.unit) continue;
    const Histogram& a = was.histogram;
    const Histogram& b = is->histogram;
    if (a.Count() == 0 || b.Count() == 0) continue;
    CompareQuantile(was, *is, 0.5, "median",
                    statistics::MannWhitneyGreater(a, most_before, b, most_after),
                    statistics::MannWhitneyGreater(b, most_after, a, most_before), figures);
    CompareQuantile(was, *is, 0.99, "99 %", statistics::TailGreater(a, most_before, b, most_after),
                    statistics::TailGreater(b, most_after, a, most_before), figures);
  }
}

using SlopeKey = std::tuple<std::string, ResourceKind>;

// The longest life of each process.
std::map<SlopeKey, const ResourceSlope*> LongestLives(const SoakResult& result) {
  std::map<SlopeKey, const ResourceSlope*> longest;
  for (const ResourceSlope& row : result.slopes) {
    const ResourceSlope*& kept = longest[{row.process, row.kind}];
    if (kept == nullptr || row.slope.spans_s > kept->slope.spans_s) kept = &row;
  }
  return longest;
}

double LeastOf(ResourceKind kind) {
  if (kind == ResourceKind::kDescriptors || kind == ResourceKind::kThreads) {
    return statistics::kLeastLeakPieces;
  }
  return kind == ResourceKind::kProcessors ? statistics::kLeastLeakProcessors
                                           : statistics::kLeastLeakBytes;
}

void CompareSlope(const ResourceSlope& was, const ResourceSlope& is, Figures* figures) {
  const double rise = is.slope.per_hour - was.slope.per_hour;
  const double error = std::hypot(was.slope.high_per_hour - was.slope.low_per_hour,
                                  is.slope.high_per_hour - is.slope.low_per_hour) /
                       kIntervalWidth;
  double p_worse = rise > 0 ? 0 : 1;  // where both are known exactly
  double p_better = rise < 0 ? 0 : 1;
  if (error > 0) {
    p_worse = statistics::NormalAbove(rise / error);
    p_better = 1 - p_worse;
  }
  const double least = LeastOf(was.kind);
  figures->Add({.figure = {.what = fmt::format("{} {} an hour", was.process, ToString(was.kind)),
                           .before = FormatResource(was.kind, was.slope.per_hour),
                           .after = FormatResource(is.kind, is.slope.per_hour)},
                .p_worse = p_worse,
                .p_better = p_better,
                .may_be_worse = rise >= least && is.slope.low_per_hour > 0,
                .may_be_better = -rise >= least && was.slope.low_per_hour > 0});
}

void CompareSlopes(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const auto lives_before = LongestLives(before);
  const auto lives_after = LongestLives(after);
  for (const auto& [key, is] : lives_after) {
    const auto was = lives_before.find(key);
    if (was != lives_before.end()) CompareSlope(*was->second, *is, figures);
  }
  std::set<std::string> leaked;
  for (const ResourceSlope& row : before.slopes) {
    if (row.leak) leaked.insert(row.process + " " + ToString(row.kind));
  }
  for (const ResourceSlope& row : after.slopes) {
    const std::string name = row.process + " " + ToString(row.kind);
    if (!row.leak || !leaked.insert(name).second) continue;
    figures->AddSure(name, "no leak", "leak", Change::kWorse);
  }
}

void CompareTimes(const std::string& what, const std::vector<double>& was,
                  const std::vector<double>& is, Figures* figures) {
  if (was.empty() || is.empty()) return;
  const double median_before = *MedianOf(was);
  const double median_after = *MedianOf(is);
  figures->Add({.figure = {.what = what,
                           .before = FormatSeconds(median_before),
                           .after = FormatSeconds(median_after)},
                .p_worse = statistics::MannWhitneyGreater(was, is),
                .p_better = statistics::MannWhitneyGreater(is, was),
                .may_be_worse = GrewEnough(median_before, median_after),
                .may_be_better = GrewEnough(median_after, median_before)});
}

void CompareShares(const std::string& what, std::size_t hits_before, std::size_t of_before,
                   std::size_t hits_after, std::size_t of_after, Figures* figures) {
  if (of_before == 0 || of_after == 0) return;
  figures->Add(
      {.figure = {.what = what,
                  .before = fmt::format("{} of {}", hits_before, of_before),
                  .after = fmt::format("{} of {}", hits_after, of_after)},
       .p_worse = statistics::ShareGreater(hits_before, of_before, hits_after, of_after),
       .p_better = statistics::ShareGreater(hits_after, of_after, hits_before, of_before)});
}

void CompareFaults(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const std::vector<FaultSummary> kinds_before = SummariesOf(before.faults);
  for (const FaultSummary& is : SummariesOf(after.faults)) {
    const auto was = std::ranges::find(kinds_before, is.kind, &FaultSummary::kind);
    if (was == kinds_before.end()) continue;
    CompareTimes(is.kind + ", noticed after", was->noticed_s, is.noticed_s, figures);
    CompareTimes(is.kind + ", recovered after", was->recovered_s, is.recovered_s, figures);
    CompareShares(is.kind + ", noticed late", was->late, was->noticed_s.size(), is.late,
                  is.noticed_s.size(), figures);
    CompareShares(is.kind + ", without effect", was->planned - was->observed, was->planned,
                  is.planned - is.observed, is.planned, figures);
  }
}

void CompareCount(const std::string& what, std::uint64_t was, double exposure_before,
                  std::uint64_t is, double exposure_after, Figures* figures) {
  if (was == 0 && is == 0) return;
  figures->Add(
      {.figure = {.what = what, .before = fmt::format("{}", was), .after = fmt::format("{}", is)},
       .p_worse = statistics::RateGreater(was, exposure_before, is, exposure_after),
       .p_better = statistics::RateGreater(is, exposure_after, was, exposure_before)});
}

void CompareCounts(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const double exposure_before = ExposureOf(before);
  const double exposure_after = ExposureOf(after);
  const auto compare = [&](const std::string& what, std::uint64_t was, std::uint64_t is) {
    CompareCount(what, was, exposure_before, is, exposure_after, figures);
  };
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> invariants;
  for (const SoakViolation& violation : before.violations) ++invariants[violation.invariant].first;
  for (const SoakViolation& violation : after.violations) ++invariants[violation.invariant].second;
  for (const auto& [invariant, counts] : invariants) {
    compare("violations: " + invariant, counts.first, counts.second);
  }
  compare("violations", before.violations_counted, after.violations_counted);
  compare("near misses", before.near_misses_counted, after.near_misses_counted);
  compare("reactions that left less than a fifth", before.budget_spent, after.budget_spent);
  compare("unplanned restarts", before.restarts_unplanned, after.restarts_unplanned);
}

void CompareVerdicts(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const auto rank = [](const SoakResult& result) {
    return result.verdict == SoakVerdict::kFailed ? 1 : 0;
  };
  const int worse_by = rank(after) - rank(before);
  figures->AddSure("verdict", ToString(before.verdict), ToString(after.verdict),
                   worse_by > 0   ? Change::kWorse
                   : worse_by < 0 ? Change::kBetter
                                  : Change::kSame);
  if (before.accounting.empty() || after.accounting.empty()) return;
  const std::size_t was = SumsOf(before.accounting).rows_that_differ;
  const std::size_t is = SumsOf(after.accounting).rows_that_differ;
  figures->AddSure("accounting, pairs that differ", fmt::format("{}", was), fmt::format("{}", is),
                   was == 0 && is > 0   ? Change::kWorse
                   : was > 0 && is == 0 ? Change::kBetter
                                        : Change::kSame);
}

}  // namespace

const char* ToString(Change change) {
  if (change == Change::kWorse) return "worse";
  return change == Change::kBetter ? "better" : "same";
}

bool SoakComparison::AnyWorse() const {
  return std::ranges::any_of(
      figures, [](const ComparedFigure& figure) { return figure.change == Change::kWorse; });
}

std::string WhyNotComparable(const SoakResult& before, const SoakResult& after) {
  std::vector<std::string> reasons;
  const auto alike = [&reasons](std::string_view what, const auto& a, const auto& b) {
    if (a != b) reasons.push_back(fmt::format("{} '{}' and '{}'", what, a, b));
  };
  alike("scenario", before.scenario, after.scenario);
  alike("faults", before.faults_file, after.faults_file);
  alike("vehicles", before.vehicles, after.vehicles);
  alike("virtual time", before.virtual_time, after.virtual_time);
  for (const SoakResult* result : {&before, &after}) {
    if (result->verdict != SoakVerdict::kNotRun) continue;
    reasons.push_back(fmt::format("the {} was not run: {}", result == &before ? "first" : "second",
                                  fmt::join(result->reasons, ", ")));
  }
  return fmt::format("{}", fmt::join(reasons, "; "));
}

SoakComparison Compare(const SoakResult& before, const SoakResult& after) {
  Figures figures;
  CompareVerdicts(before, after, &figures);
  CompareHistograms(before, after, &figures);
  CompareSlopes(before, after, &figures);
  CompareFaults(before, after, &figures);
  CompareCounts(before, after, &figures);
  return {std::move(figures).Judged()};
}

}  // namespace giveway::fleetctl
