// Converts the message of idl/soak.proto to a soak's result; reports all mismatches at once.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/soak_schema.h"

namespace giveway::fleetctl {
namespace {

constexpr double kMostExact = 9007199254740992.0;  // 2^53

class Complaints {
 public:
  void Add(std::string field, const std::string& value, const std::string& rule) {
    if (complaints_.size() < kMost) {
      complaints_.push_back(fmt::format("{} is {}, must be {}", field, value, rule));
    }
  }
  std::string Text() const { return fmt::format("{}", fmt::join(complaints_, "; ")); }

 private:
  static constexpr std::size_t kMost = 20;
  std::vector<std::string> complaints_;
};

std::uint64_t CountOf(double value, const std::string& field, Complaints* complaints) {
  if (value >= 0 && value <= kMostExact && value == std::floor(value)) {
    return static_cast<std::uint64_t>(value);
  }
  complaints->Add(field, fmt::format("{}", value), "a whole number from 0");
  return 0;
}

SoakVerdict VerdictOf(const schema::SoakReport& message, Complaints* complaints) {
  switch (message.verdict()) {
    case schema::SoakReport::passed:
      return SoakVerdict::kPassed;
    case schema::SoakReport::failed:
      return SoakVerdict::kFailed;
    case schema::SoakReport::interrupted:
      return SoakVerdict::kInterrupted;
    case schema::SoakReport::not_run:
      return SoakVerdict::kNotRun;
    default:
      break;
  }
  complaints->Add("verdict", fmt::format("{}", static_cast<int>(message.verdict())),
                  "passed, failed, not_run or interrupted");
  return SoakVerdict::kNotRun;
}

SoakFault FaultFrom(const schema::SoakFault& message) {
  SoakFault fault{.rule = message.rule(),
                  .nth = message.nth(),
                  .at_s = message.at_s(),
                  .for_s = message.for_s(),
                  .kind = message.kind(),
                  .target = message.target(),
                  .observed = message.observed(),
                  .observed_how = message.observed_how()};
  if (message.has_observed_s()) fault.observed_s = message.observed_s();
  if (message.has_noticed_after_s()) fault.noticed_after_s = message.noticed_after_s();
  if (message.has_promised_s()) fault.promised_s = message.promised_s();
  if (message.has_recovered_after_s()) fault.recovered_after_s = message.recovered_after_s();
  return fault;
}

// Of a list that has one number for each block of time, or for fewer.
template <typename Numbers>
std::vector<std::uint64_t> ByBlockFrom(const Numbers& numbers, const std::string& field,
                                       Complaints* complaints) {
  std::vector<std::uint64_t> counts;
  if (static_cast<std::size_t>(numbers.size()) > kSoakBlocks) {
    complaints->Add(field, fmt::format("{} numbers", numbers.size()),
                    fmt::format("at most {}", kSoakBlocks));
    return counts;
  }
  for (const double number : numbers) counts.push_back(CountOf(number, field, complaints));
  return counts;
}

std::vector<BlockSummary> BlocksFrom(const schema::SoakHistogram& message, const std::string& field,
                                     Complaints* complaints) {
  const auto counts = ByBlockFrom(message.block_values(), field + ".block_values", complaints);
  const auto mean = ByBlockFrom(message.block_mean(), field + ".block_mean", complaints);
  const auto p50 = ByBlockFrom(message.block_p50(), field + ".block_p50", complaints);
  const auto p99 = ByBlockFrom(message.block_p99(), field + ".block_p99", complaints);
  if (mean.size() != counts.size() || p50.size() != counts.size() || p99.size() != counts.size()) {
    complaints->Add(field + ".block_mean, block_p50, block_p99",
                    fmt::format("{}, {}, {} numbers", mean.size(), p50.size(), p99.size()),
                    fmt::format("as many as block_values: {}", counts.size()));
    return {};
  }
  std::vector<BlockSummary> blocks;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    blocks.push_back({counts[i], static_cast<std::int64_t>(mean[i]),
                      static_cast<std::int64_t>(p50[i]), static_cast<std::int64_t>(p99[i])});
  }
  return blocks;
}

SoakHistogram HistogramFrom(const schema::SoakHistogram& message, const std::string& field,
                            Complaints* complaints) {
  SoakHistogram measured;
  measured.name = message.name();
  const auto unit = HistogramUnitOf(message.unit());
  if (!unit) {
    complaints->Add(field + ".unit", "\"" + message.unit() + "\"", "\"ns\", \"um\" or \"ppm\"");
  }
  measured.unit = unit.value_or(HistogramUnit::kNanoseconds);
  if (message.lowest_size() != message.count_size()) {
    complaints->Add(field + ".count", fmt::format("{} numbers", message.count_size()),
                    fmt::format("as many as lowest: {}", message.lowest_size()));
    return measured;
  }
  std::vector<HistogramBucket> buckets;
  for (int i = 0; i < message.lowest_size(); ++i) {
    const std::uint64_t lowest = CountOf(message.lowest(i), field + ".lowest", complaints);
    buckets.push_back({static_cast<std::int64_t>(lowest),
                       CountOf(message.count(i), field + ".count", complaints)});
  }
  const auto min = CountOf(message.min(), field + ".min", complaints);
  const auto max = CountOf(message.max(), field + ".max", complaints);
  const auto read =
      Histogram::From(buckets, static_cast<std::int64_t>(min), static_cast<std::int64_t>(max),
                      CountOf(message.clamped(), field + ".clamped", complaints));
  if (read) {
    measured.histogram = *read;
  } else {
    complaints->Add(field, fmt::format("{} buckets", buckets.size()),
                    "ascending buckets of a histogram, min and max in the first and the last");
  }
  measured.blocks = BlocksFrom(message, field, complaints);
  for (const schema::SoakBudget& budget : message.budgets()) {
    measured.budgets.push_back(
        {budget.quantile(),
         static_cast<std::int64_t>(CountOf(budget.most(), field + ".budgets.most", complaints))});
  }
  return measured;
}

ResourceSlope SlopeFrom(const schema::SoakSlope& message, const std::string& field,
                        Complaints* complaints) {
  ResourceSlope row;
  row.process = message.process();
  row.life = message.life();
  if (const auto kind = ResourceKindOf(message.kind())) {
    row.kind = *kind;
  } else {
    complaints->Add(field + ".kind", "\"" + message.kind() + "\"", "a resource of idl/soak.proto");
  }
  row.slope = {.per_hour = message.per_hour(),
               .low_per_hour = message.low_per_hour(),
               .high_per_hour = message.high_per_hour(),
               .samples = message.samples(),
               .spans_s = message.spans_s(),
               .chance = message.chance()};
  row.last = message.last();
  row.leak = message.leak();
  if (message.curve_s_size() != message.curve_size()) {
    complaints->Add(field + ".curve", fmt::format("{} numbers", message.curve_size()),
                    fmt::format("as many as curve_s: {}", message.curve_s_size()));
    return row;
  }
  for (int i = 0; i < message.curve_s_size(); ++i) {
    row.curve.push_back({message.curve_s(i), message.curve(i)});
  }
  return row;
}

AccountingRow AccountingFrom(const schema::SoakAccounting& message, const std::string& field,
                             Complaints* complaints) {
  const auto count = [&](double value, const char* name) {
    return CountOf(value, field + "." + name, complaints);
  };
  return {.writer = message.writer(),
          .reader = message.reader(),
          .topic = message.topic(),
          .sent = count(message.sent(), "sent"),
          .accepted = count(message.accepted(), "accepted"),
          .not_heard = count(message.not_heard(), "not_heard"),
          .refused = count(message.refused(), "refused"),
          .superseded = count(message.superseded(), "superseded"),
          .lost = count(message.lost(), "lost")};
}

void ReadHead(const schema::SoakReport& message, SoakResult* result, Complaints* complaints) {
  if (message.format() != kSoakFormat) {
    complaints->Add("format", fmt::format("{}", message.format()), fmt::format("{}", kSoakFormat));
  }
  result->verdict = VerdictOf(message, complaints);
  result->reasons = {message.reasons().begin(), message.reasons().end()};
  result->scenario = message.scenario();
  result->seed = CountOf(message.seed(), "seed", complaints);
  result->planned_s = message.planned_s();
  result->ran_s = message.ran_s();
  result->vehicles = message.vehicles();
  result->domain = message.domain();
  result->virtual_time = message.virtual_time();
  result->faults_file = message.faults_file();
  result->qos_set = message.qos_set();
  result->qos_hash = message.qos_hash();
  result->versions = {{},
                      message.versions().fast_dds(),
                      message.versions().kernel(),
                      message.versions().host_cores()};
  for (const auto& program : message.versions().programs()) {
    result->versions.programs.push_back({program.name(), program.build_id()});
  }
  result->command = message.command();
}

void ReadEvents(const schema::SoakReport& message, SoakResult* result, Complaints* complaints) {
  for (const schema::SoakFault& fault : message.faults()) {
    result->faults.push_back(FaultFrom(fault));
  }
  result->skipped_faults = {message.skipped_faults().begin(), message.skipped_faults().end()};
  result->skipped_counted =
      std::max<std::uint64_t>(CountOf(message.skipped_counted(), "skipped_counted", complaints),
                              result->skipped_faults.size());
  for (const schema::SoakViolation& violation : message.violations()) {
    result->violations.push_back({violation.time_s(), VehicleId{violation.vehicle()},
                                  VehicleId{violation.other()}, violation.invariant(),
                                  violation.words(), violation.fault()});
  }
  for (const schema::SoakNearMiss& miss : message.near_misses()) {
    result->near_misses.push_back({miss.time_s(), VehicleId{miss.vehicle()},
                                   VehicleId{miss.other()}, miss.x_m(), miss.y_m(),
                                   miss.distance_m()});
  }
  for (const schema::SoakMode& mode : message.modes()) {
    result->modes.push_back({mode.time_s(), VehicleId{mode.vehicle()}, mode.mode()});
  }
  result->violations_counted =
      CountOf(message.violations_counted(), "violations_counted", complaints);
  result->near_misses_counted =
      CountOf(message.near_misses_counted(), "near_misses_counted", complaints);
  result->modes_counted = CountOf(message.modes_counted(), "modes_counted", complaints);
  result->ticks_judged = CountOf(message.ticks_judged(), "ticks_judged", complaints);
  result->ticks_unseen = CountOf(message.ticks_unseen(), "ticks_unseen", complaints);
  result->faults_counted = CountOf(message.faults_counted(), "faults_counted", complaints);
  result->faults_observed = CountOf(message.faults_observed(), "faults_observed", complaints);
}

void ReadFigures(const schema::SoakReport& message, SoakResult* result, Complaints* complaints) {
  for (const schema::SoakHistogram& histogram : message.histograms()) {
    const std::string field = fmt::format("histograms[{}]", result->histograms.size());
    result->histograms.push_back(HistogramFrom(histogram, field, complaints));
  }
  for (const schema::SoakSlope& slope : message.slopes()) {
    const std::string field = fmt::format("slopes[{}]", result->slopes.size());
    result->slopes.push_back(SlopeFrom(slope, field, complaints));
  }
  for (const schema::SoakAccounting& row : message.accounting()) {
    const std::string field = fmt::format("accounting[{}]", result->accounting.size());
    result->accounting.push_back(AccountingFrom(row, field, complaints));
  }
  result->lives_too_short = CountOf(message.lives_too_short(), "lives_too_short", complaints);
  result->pauses = {CountOf(message.pauses().count(), "pauses.count", complaints),
                    message.pauses().total_s(), message.pauses().longest_s(),
                    message.pauses().share()};
  if (message.has_narrowest_margin()) {
    const schema::SoakMargin& margin = message.narrowest_margin();
    result->narrowest_margin = {margin.time_s(), VehicleId{margin.vehicle()}, margin.reaction_m(),
                                margin.free_m(), margin.share_left()};
  }
  for (const schema::SoakKeptRings& kept : message.kept_rings()) {
    result->kept_rings.push_back({kept.time_s(), kept.ordered(), kept.kept(), kept.page()});
  }
  result->resumed_at_s = {message.resumed_at_s().begin(), message.resumed_at_s().end()};
  result->budget_spent = CountOf(message.budget_spent(), "budget_spent", complaints);
  result->block_s = message.block_s();
  result->near_misses_by_block =
      ByBlockFrom(message.near_misses_by_block(), "near_misses_by_block", complaints);
  result->budget_spent_by_block =
      ByBlockFrom(message.budget_spent_by_block(), "budget_spent_by_block", complaints);
  result->timing_values_lost =
      CountOf(message.timing_values_lost(), "timing_values_lost", complaints);
  result->restarts_planned = message.restarts_planned();
  result->restarts_unplanned = message.restarts_unplanned();
  if (message.has_supervisor_cpu_share()) {
    result->supervisor_cpu_share = message.supervisor_cpu_share();
  }
}

}  // namespace

std::string ReadInto(const schema::SoakReport& message, SoakResult* result) {
  Complaints complaints;
  ReadHead(message, result, &complaints);
  ReadEvents(message, result, &complaints);
  ReadFigures(message, result, &complaints);
  return complaints.Text();
}

}  // namespace giveway::fleetctl
