#include "services/fleetctl/report/report_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "services/fleetctl/soak/resource_series.h"
#include "services/fleetctl/soak/soak_format.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "services/statistics/distributions.h"
#include "services/statistics/two_sample.h"

namespace giveway::fleetctl {
namespace {

constexpr double kLeastChange = 0.05;                     // of a time; less does not matter
constexpr double kSameBlocks = 1e-3;                      // of a block's length
constexpr double kLeastLikeSpan = 0.75;                   // the shorter of two lives, of the longer
constexpr double kIntervalWidth = 2 * 1.959963984540054;  // of 95 %, in standard deviations

// Why a figure was not tested.
constexpr const char* kNoBlocks = "a report without blocks of time: it is older, or was resumed";
constexpr const char* kOtherLengths = "soaks of different durations";
constexpr const char* kTooShort = "one of them ended within its first block of time";
constexpr const char* kOneEvent = "all values stem from one event, and one soak cannot decide";
constexpr const char* kNotAllListed = "not all violations are listed with their times";
constexpr const char* kNotAllFaults = "not all faults are listed";
constexpr const char* kUnlikeLives = "lives that are too short, or of different lengths";
constexpr const char* kAreViolations = "each is among the violations";

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
    sure_.push_back(
        {std::move(what), std::move(before), std::move(after), change, std::nullopt, {}});
  }
  void AddUntested(ComparedFigure figure, std::string why) {
    if (figure.before != figure.after) figure.change = Change::kUntested;
    figure.why_untested = std::move(why);
    sure_.push_back(std::move(figure));
  }

  // Unless there is a reason not to test it.
  void AddUnless(const std::string& why_not, TestedFigure tested) {
    if (why_not.empty()) return Add(std::move(tested));
    AddUntested(std::move(tested.figure), why_not);
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
      constexpr std::array kOrder{Change::kWorse, Change::kBetter, Change::kUntested};
      return std::ranges::find(kOrder, figure.change) - kOrder.begin();
    };
    std::ranges::stable_sort(figures, {}, place);
    return figures;
  }

 private:
  std::vector<ComparedFigure> sure_;
  std::vector<TestedFigure> tested_;
};

bool GrewEnough(double before, double after) { return after > before * (1 + kLeastChange); }

// The blocks of time of two soaks, place by place: what one did in a block is independent of what
// it did in others, and two of equal programs are as likely in the one order as in the other.
struct CommonBlocks {
  std::size_t count = 0;  // that both have in full
  std::string why_none;   // empty: they can be compared
};

CommonBlocks CommonBlocksOf(const SoakResult& before, const SoakResult& after) {
  if (!(before.block_s > 0 && after.block_s > 0)) return {0, kNoBlocks};
  if (std::abs(before.block_s - after.block_s) > kSameBlocks * before.block_s) {
    return {0, kOtherLengths};
  }
  const double full = std::min(before.ran_s, after.ran_s) / before.block_s + kSameBlocks;
  if (!(full >= 1)) return {0, kTooShort};
  return {static_cast<std::size_t>(std::min(full, static_cast<double>(kSoakBlocks))), {}};
}

// Of each block in which both have values.
struct BlockSeries {
  std::vector<double> before;
  std::vector<double> after;
};

BlockSeries SeriesOf(const SoakHistogram& before, const SoakHistogram& after, std::size_t blocks,
                     std::int64_t BlockSummary::*part) {
  BlockSeries series;
  for (std::size_t i = 0; i < std::min({blocks, before.blocks.size(), after.blocks.size()}); ++i) {
    const BlockSummary& was = before.blocks[i];
    const BlockSummary& is = after.blocks[i];
    if (was.count == 0 || is.count == 0) continue;
    series.before.push_back(static_cast<double>(was.*part));
    series.after.push_back(static_cast<double>(is.*part));
  }
  return series;
}

void AddSeries(TestedFigure tested, const BlockSeries& series, const std::string& why_not,
               Figures* figures) {
  if (why_not.empty()) {
    tested.p_worse = statistics::SeriesGreater(series.before, series.after);
    tested.p_better = statistics::SeriesGreater(series.after, series.before);
  }
  figures->AddUnless(why_not, std::move(tested));
}

// Of the whole run, in the unit of both.
TestedFigure FigureOf(const SoakHistogram& measured, std::string_view part, std::int64_t was,
                      std::int64_t is) {
  const auto number = [](std::int64_t value) { return static_cast<double>(value); };
  return {.figure = {.what = fmt::format("{}, {}", measured.name, part),
                     .before = FormatValue(measured.unit, was),
                     .after = FormatValue(measured.unit, is)},
          .may_be_worse = GrewEnough(number(was), number(is)),
          .may_be_better = GrewEnough(number(is), number(was))};
}

// Those of faults are compared by kind.
bool IsOfFaults(const SoakHistogram& measured) {
  return measured.name == "noticed" || measured.name == "recovered";
}

void CompareHistograms(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const CommonBlocks blocks = CommonBlocksOf(before, after);
  for (const SoakHistogram& was : before.histograms) {
    const auto is = std::ranges::find(after.histograms, was.name, &SoakHistogram::name);
    if (is == after.histograms.end() || is->unit != was.unit || IsOfFaults(was)) continue;
    if (was.histogram.Count() == 0 || is->histogram.Count() == 0) continue;
    const bool by_block = !was.blocks.empty() && !is->blocks.empty();
    const std::string why_not = !blocks.why_none.empty() ? blocks.why_none
                                : by_block               ? ""
                                                         : kOneEvent;
    const auto add = [&](std::string_view part, std::int64_t all_before, std::int64_t all_after,
                         std::int64_t BlockSummary::*of_block) {
      AddSeries(FigureOf(was, part, all_before, all_after),
                SeriesOf(was, *is, blocks.count, of_block), why_not, figures);
    };
    const Histogram& a = was.histogram;
    const Histogram& b = is->histogram;
    add("mean", std::llround(a.Mean()), std::llround(b.Mean()), &BlockSummary::mean);
    add("median", a.Quantile(0.5), b.Quantile(0.5), &BlockSummary::p50);
    add("99 %", a.Quantile(0.99), b.Quantile(0.99), &BlockSummary::p99);
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

// What fills up grows, by the hour, the more the shorter the life.
bool AreLikeLives(const ResourceSlope& was, const ResourceSlope& is) {
  const auto [shorter_s, longer_s] = std::minmax(was.slope.spans_s, is.slope.spans_s);
  return shorter_s >= kLeastLeakSpan_s && shorter_s >= kLeastLikeSpan * longer_s;
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
  figures->AddUnless(
      AreLikeLives(was, is) ? "" : kUnlikeLives,
      {.figure = {.what = fmt::format("{} {} an hour", was.process, ToString(was.kind)),
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

// What the faults of one kind say: those of one block of time may share a cause, and come to one
// value.
struct FaultEvidence {
  std::vector<double> noticed_s;  // the median of each block
  std::vector<double> recovered_s;
  std::size_t late = 0;  // blocks with any
  std::size_t without_effect = 0;
  std::size_t blocks = 0;
};

std::map<std::string, FaultEvidence> EvidenceOf(const SoakResult& result, double block_s) {
  std::vector<std::vector<SoakFault>> by_block(kSoakBlocks);
  for (const SoakFault& fault : result.faults) {
    by_block[BlockOf(StartOf(fault), block_s)].push_back(fault);
  }
  std::map<std::string, FaultEvidence> evidence;
  for (const std::vector<SoakFault>& faults : by_block) {
    for (const FaultSummary& summary : SummariesOf(faults)) {
      FaultEvidence& kind = evidence[summary.kind];
      ++kind.blocks;
      if (summary.late > 0) ++kind.late;
      if (summary.missing > 0) ++kind.without_effect;
      if (const auto noticed_s = MedianOf(summary.noticed_s)) kind.noticed_s.push_back(*noticed_s);
      if (const auto back_s = MedianOf(summary.recovered_s)) kind.recovered_s.push_back(*back_s);
    }
  }
  return evidence;
}

// The figures of one kind are those of all its faults, the tests those of the blocks.
class KindComparison {
 public:
  // `why_not`: why nothing is tested; empty: it is.
  KindComparison(std::string kind, std::string why_not, Figures* figures)
      : kind_(std::move(kind)), why_not_(std::move(why_not)), figures_(*figures) {}

  void CompareTimes(std::string_view what, const std::vector<double>& was,
                    const std::vector<double>& blocks_before, const std::vector<double>& is,
                    const std::vector<double>& blocks_after) {
    if (was.empty() || is.empty()) return;
    const double median_before = *MedianOf(was);
    const double median_after = *MedianOf(is);
    Add({.figure = FigureOf(what, FormatSeconds(median_before), FormatSeconds(median_after)),
         .p_worse = statistics::MannWhitneyGreater(blocks_before, blocks_after),
         .p_better = statistics::MannWhitneyGreater(blocks_after, blocks_before),
         .may_be_worse = GrewEnough(median_before, median_after),
         .may_be_better = GrewEnough(median_after, median_before)});
  }

  struct Share {
    std::size_t hits = 0;
    std::size_t of = 0;
  };
  void CompareShares(std::string_view what, Share was, Share blocks_before, Share is,
                     Share blocks_after) {
    if (was.of == 0 || is.of == 0) return;
    const auto greater = [](Share a, Share b) {
      return statistics::ShareGreater(a.hits, a.of, b.hits, b.of);
    };
    Add({.figure = FigureOf(what, fmt::format("{} of {}", was.hits, was.of),
                            fmt::format("{} of {}", is.hits, is.of)),
         .p_worse = greater(blocks_before, blocks_after),
         .p_better = greater(blocks_after, blocks_before)});
  }

 private:
  // Of a part of the faults nothing is known to be the same.
  ComparedFigure FigureOf(std::string_view what, std::string before, std::string after) const {
    return {.what = fmt::format("{}, {}", kind_, what),
            .before = std::move(before),
            .after = std::move(after),
            .change = why_not_.empty() ? Change::kSame : Change::kUntested};
  }
  void Add(TestedFigure tested) { figures_.AddUnless(why_not_, std::move(tested)); }

  std::string kind_;
  std::string why_not_;
  Figures& figures_;
};

void CompareKind(const FaultSummary& was, const FaultEvidence& a, const FaultSummary& is,
                 const FaultEvidence& b, KindComparison kind) {
  kind.CompareTimes("noticed after", was.noticed_s, a.noticed_s, is.noticed_s, b.noticed_s);
  kind.CompareTimes("recovered after", was.recovered_s, a.recovered_s, is.recovered_s,
                    b.recovered_s);
  kind.CompareShares("noticed late", {was.late, was.noticed_s.size()}, {a.late, a.noticed_s.size()},
                     {is.late, is.noticed_s.size()}, {b.late, b.noticed_s.size()});
  kind.CompareShares("without effect", {was.missing, was.planned}, {a.without_effect, a.blocks},
                     {is.missing, is.planned}, {b.without_effect, b.blocks});
}

bool ListsAllFaults(const SoakResult& result) {
  return result.faults_counted <= result.faults.size();
}

void CompareFaults(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const double block_s =
      BlockSeconds(std::max({before.planned_s, before.ran_s, after.planned_s, after.ran_s}));
  auto evidence_before = EvidenceOf(before, block_s);
  auto evidence_after = EvidenceOf(after, block_s);
  const bool all_listed = ListsAllFaults(before) && ListsAllFaults(after);
  const std::vector<FaultSummary> kinds_before = SummariesOf(before.faults);
  for (const FaultSummary& is : SummariesOf(after.faults)) {
    const auto was = std::ranges::find(kinds_before, is.kind, &FaultSummary::kind);
    if (was == kinds_before.end()) continue;
    CompareKind(*was, evidence_before[is.kind], is, evidence_after[is.kind],
                {is.kind, all_listed ? "" : kNotAllFaults, figures});
  }
}

std::vector<double> Numbers(const std::vector<std::uint64_t>& counts, std::size_t blocks) {
  std::vector<double> numbers(blocks);
  for (std::size_t i = 0; i < std::min(blocks, counts.size()); ++i) {
    numbers[i] = static_cast<double>(counts[i]);
  }
  return numbers;
}

struct CountByBlock {
  std::uint64_t all = 0;
  std::vector<std::uint64_t> by_block;
};

void CompareCount(const std::string& what, const CountByBlock& was, const CountByBlock& is,
                  const CommonBlocks& blocks, Figures* figures) {
  if (was.all == 0 && is.all == 0) return;
  AddSeries({.figure = {.what = what,
                        .before = fmt::format("{}", was.all),
                        .after = fmt::format("{}", is.all)}},
            {Numbers(was.by_block, blocks.count), Numbers(is.by_block, blocks.count)},
            blocks.why_none, figures);
}

// By invariant; all together under no name.
std::map<std::string, CountByBlock> ViolationsOf(const SoakResult& result) {
  std::map<std::string, CountByBlock> violations;
  const auto count = [&result](CountByBlock* counted, double time_s) {
    counted->by_block.resize(kSoakBlocks);
    ++counted->all;
    ++counted->by_block[BlockOf(time_s, result.block_s)];
  };
  for (const SoakViolation& violation : result.violations) {
    count(&violations[violation.invariant], violation.time_s);
    count(&violations[{}], violation.time_s);
  }
  violations[{}].all = result.violations_counted;
  return violations;
}

void CompareViolations(const SoakResult& before, const SoakResult& after, CommonBlocks blocks,
                       Figures* figures) {
  for (const SoakResult* result : {&before, &after}) {
    if (result->violations_counted > result->violations.size()) blocks.why_none = kNotAllListed;
  }
  auto was = ViolationsOf(before);
  auto is = ViolationsOf(after);
  std::set<std::string> names;
  for (const auto* by_name : {&was, &is}) {
    for (const auto& [name, count] : *by_name) names.insert(name);
  }
  for (const std::string& name : names) {
    CompareCount(name.empty() ? "violations" : "violations: " + name, was[name], is[name], blocks,
                 figures);
  }
}

void CompareCounts(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const CommonBlocks blocks = CommonBlocksOf(before, after);
  CompareViolations(before, after, blocks, figures);
  CompareCount("near misses", {before.near_misses_counted, before.near_misses_by_block},
               {after.near_misses_counted, after.near_misses_by_block}, blocks, figures);
  CompareCount("reactions that left less than a fifth",
               {before.budget_spent, before.budget_spent_by_block},
               {after.budget_spent, after.budget_spent_by_block}, blocks, figures);
  // Each of them is a violation, with its time.
  CompareCount("unplanned restarts", {before.restarts_unplanned, {}},
               {after.restarts_unplanned, {}}, {0, kAreViolations}, figures);
}

void CompareVerdicts(const SoakResult& before, const SoakResult& after, Figures* figures) {
  const auto rank = [](const SoakResult& result) {
    return result.verdict == SoakVerdict::kPassed ? 0 : 1;
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
  switch (change) {
    case Change::kWorse:
      return "worse";
    case Change::kBetter:
      return "better";
    case Change::kUntested:
      return "untested";
    case Change::kSame:
      break;
  }
  return "same";
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
