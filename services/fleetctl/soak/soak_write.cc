// A soak's result as the message of idl/soak.proto.
#include <algorithm>
#include <cmath>
#include <span>

#include "services/fleetctl/soak/soak_schema.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

// Micrometres, microseconds: no digit printed is noise.
double Printable(double value) {
  return std::isfinite(value) ? std::round(value * 1e6) / 1e6 : 0.0;
}

bool Exists(const std::optional<double>& value) { return value && std::isfinite(*value); }

template <typename Integer>
double AsDouble(Integer value) {
  return static_cast<double>(value);
}

void Write(const SoakFault& fault, schema::SoakFault* message) {
  message->set_rule(WellFormed(fault.rule));
  message->set_nth(fault.nth);
  message->set_at_s(Printable(fault.at_s));
  message->set_for_s(Printable(fault.for_s));
  message->set_kind(WellFormed(fault.kind));
  message->set_target(WellFormed(fault.target));
  message->set_observed(fault.observed);
  message->set_observed_how(WellFormed(fault.observed_how));
  if (Exists(fault.observed_s)) message->set_observed_s(Printable(*fault.observed_s));
  if (Exists(fault.noticed_after_s)) {
    message->set_noticed_after_s(Printable(*fault.noticed_after_s));
  }
  if (Exists(fault.promised_s)) message->set_promised_s(Printable(*fault.promised_s));
  if (Exists(fault.recovered_after_s)) {
    message->set_recovered_after_s(Printable(*fault.recovered_after_s));
  }
}

void Write(const SoakViolation& violation, schema::SoakViolation* message) {
  message->set_time_s(Printable(violation.time_s));
  message->set_vehicle(Number(violation.vehicle));
  message->set_other(Number(violation.other));
  message->set_invariant(WellFormed(violation.invariant));
  message->set_words(WellFormed(violation.words));
  message->set_fault(WellFormed(violation.fault));
}

void Write(const NearMiss& miss, schema::SoakNearMiss* message) {
  message->set_time_s(Printable(miss.time_s));
  message->set_vehicle(Number(miss.vehicle));
  message->set_other(Number(miss.other));
  message->set_x_m(Printable(miss.x_m));
  message->set_y_m(Printable(miss.y_m));
  message->set_distance_m(Printable(miss.distance_m));
}

void Write(const ModeChange& change, schema::SoakMode* message) {
  message->set_time_s(Printable(change.time_s));
  message->set_vehicle(Number(change.vehicle));
  message->set_mode(WellFormed(change.mode));
}

void Write(const SoakHistogram& measured, schema::SoakHistogram* message) {
  const Histogram& histogram = measured.histogram;
  message->set_name(WellFormed(measured.name));
  message->set_unit(ToString(measured.unit));
  message->set_min(AsDouble(histogram.Min()));
  message->set_max(AsDouble(histogram.Max()));
  message->set_clamped(AsDouble(histogram.Clamped()));
  for (const HistogramBucket& bucket : histogram.Buckets()) {
    message->add_lowest(AsDouble(bucket.lowest));
    message->add_count(AsDouble(bucket.count));
  }
  for (const HistogramBudget& budget : measured.budgets) {
    schema::SoakBudget& written = *message->add_budgets();
    written.set_quantile(Printable(budget.quantile));
    written.set_most(AsDouble(budget.most));
  }
  message->set_values(AsDouble(histogram.Count()));
  message->set_p50(AsDouble(histogram.Quantile(0.5)));
  message->set_p99(AsDouble(histogram.Quantile(0.99)));
  message->set_p999(AsDouble(histogram.Quantile(0.999)));
  for (const BlockSummary& block : measured.blocks) {
    message->add_block_values(AsDouble(block.count));
    message->add_block_mean(AsDouble(block.mean));
    message->add_block_p50(AsDouble(block.p50));
    message->add_block_p99(AsDouble(block.p99));
  }
}

void Write(const ResourceSlope& row, schema::SoakSlope* message) {
  message->set_process(WellFormed(row.process));
  message->set_life(row.life);
  message->set_kind(ToString(row.kind));
  message->set_per_hour(Printable(row.slope.per_hour));
  message->set_low_per_hour(Printable(row.slope.low_per_hour));
  message->set_high_per_hour(Printable(row.slope.high_per_hour));
  message->set_samples(static_cast<std::uint32_t>(row.slope.samples));
  message->set_spans_s(Printable(row.slope.spans_s));
  message->set_last(Printable(row.last));
  message->set_chance(Printable(row.slope.chance));
  message->set_leak(row.leak);
  for (const statistics::Sample& sample : row.curve) {
    message->add_curve_s(Printable(sample.time_s));
    message->add_curve(Printable(sample.value));
  }
}

void Write(const AccountingRow& row, schema::SoakAccounting* message) {
  message->set_writer(WellFormed(row.writer));
  message->set_reader(WellFormed(row.reader));
  message->set_topic(WellFormed(row.topic));
  message->set_sent(AsDouble(row.sent));
  message->set_accepted(AsDouble(row.accepted));
  message->set_not_heard(AsDouble(row.not_heard));
  message->set_refused(AsDouble(row.refused));
  message->set_superseded(AsDouble(row.superseded));
  message->set_lost(AsDouble(row.lost));
  message->set_difference(AsDouble(row.Difference()));
}

template <typename Item>
std::span<const Item> FirstOf(const std::vector<Item>& items) {
  return std::span(items).first(std::min(items.size(), kMostListed));
}

template <typename Item, typename Add>
void WriteAll(const std::vector<Item>& items, Add&& add) {
  for (const Item& item : FirstOf(items)) Write(item, add());
}

void WriteHead(const SoakResult& result, schema::SoakReport* message) {
  message->set_format(kSoakFormat);
  message->set_verdict(result.verdict == SoakVerdict::kPassed   ? schema::SoakReport::passed
                       : result.verdict == SoakVerdict::kFailed ? schema::SoakReport::failed
                       : result.verdict == SoakVerdict::kInterrupted
                           ? schema::SoakReport::interrupted
                           : schema::SoakReport::not_run);
  for (const std::string& reason : result.reasons) message->add_reasons(WellFormed(reason));
  message->set_scenario(WellFormed(result.scenario));
  message->set_seed(AsDouble(result.seed));
  message->set_planned_s(Printable(result.planned_s));
  message->set_ran_s(Printable(result.ran_s));
  message->set_vehicles(result.vehicles);
  message->set_domain(result.domain);
  message->set_virtual_time(result.virtual_time);
  message->set_faults_file(WellFormed(result.faults_file));
  message->set_qos_set(WellFormed(result.qos_set));
  message->set_qos_hash(WellFormed(result.qos_hash));
  for (const SoakProgram& program : result.versions.programs) {
    auto* written = message->mutable_versions()->add_programs();
    written->set_name(WellFormed(program.name));
    written->set_build_id(WellFormed(program.build_id));
  }
  message->mutable_versions()->set_fast_dds(WellFormed(result.versions.fast_dds));
  message->mutable_versions()->set_kernel(WellFormed(result.versions.kernel));
  message->mutable_versions()->set_host_cores(result.versions.host_cores);
  message->set_command(WellFormed(result.command));
}

void WriteBlocks(const SoakResult& result, schema::SoakReport* message) {
  message->set_block_s(Printable(result.block_s));
  for (const std::uint64_t count : result.near_misses_by_block) {
    message->add_near_misses_by_block(AsDouble(count));
  }
  for (const std::uint64_t count : result.budget_spent_by_block) {
    message->add_budget_spent_by_block(AsDouble(count));
  }
}

}  // namespace

schema::SoakReport SchemaOf(const SoakResult& result) {
  schema::SoakReport message;
  WriteHead(result, &message);
  WriteAll(result.faults, [&message] { return message.add_faults(); });
  message.set_faults_counted(AsDouble(result.faults_counted));
  message.set_faults_observed(AsDouble(result.faults_observed));
  message.set_ticks_judged(AsDouble(result.ticks_judged));
  message.set_ticks_unseen(AsDouble(result.ticks_unseen));
  for (const std::string& skipped : FirstOf(result.skipped_faults)) {
    message.add_skipped_faults(WellFormed(skipped));
  }
  message.set_skipped_counted(AsDouble(result.skipped_counted));
  WriteAll(result.violations, [&message] { return message.add_violations(); });
  message.set_violations_counted(
      AsDouble(std::max<std::uint64_t>(result.violations_counted, result.violations.size())));
  WriteAll(result.near_misses, [&message] { return message.add_near_misses(); });
  message.set_near_misses_counted(
      AsDouble(std::max<std::uint64_t>(result.near_misses_counted, result.near_misses.size())));
  WriteAll(result.modes, [&message] { return message.add_modes(); });
  message.set_modes_counted(
      AsDouble(std::max<std::uint64_t>(result.modes_counted, result.modes.size())));
  WriteAll(result.histograms, [&message] { return message.add_histograms(); });
  WriteAll(result.slopes, [&message] { return message.add_slopes(); });
  message.set_lives_too_short(AsDouble(result.lives_too_short));
  WriteAll(result.accounting, [&message] { return message.add_accounting(); });
  message.mutable_pauses()->set_count(AsDouble(result.pauses.count));
  message.mutable_pauses()->set_total_s(Printable(result.pauses.total_s));
  message.mutable_pauses()->set_longest_s(Printable(result.pauses.longest_s));
  message.mutable_pauses()->set_share(Printable(result.pauses.share));
  if (const auto& margin = result.narrowest_margin) {
    message.mutable_narrowest_margin()->set_time_s(Printable(margin->time_s));
    message.mutable_narrowest_margin()->set_vehicle(Number(margin->vehicle));
    message.mutable_narrowest_margin()->set_reaction_m(Printable(margin->reaction_m));
    message.mutable_narrowest_margin()->set_free_m(Printable(margin->free_m));
    message.mutable_narrowest_margin()->set_share_left(Printable(margin->share_left));
  }
  for (const KeptRings& kept : result.kept_rings) {
    schema::SoakKeptRings& written = *message.add_kept_rings();
    written.set_time_s(Printable(kept.time_s));
    written.set_ordered(kept.ordered);
    written.set_kept(kept.kept);
    written.set_page(kept.page);
  }
  for (const double at_s : result.resumed_at_s) message.add_resumed_at_s(Printable(at_s));
  message.set_budget_spent(AsDouble(result.budget_spent));
  WriteBlocks(result, &message);
  message.set_timing_values_lost(AsDouble(result.timing_values_lost));
  message.set_restarts_planned(result.restarts_planned);
  message.set_restarts_unplanned(result.restarts_unplanned);
  if (Exists(result.supervisor_cpu_share)) {
    message.set_supervisor_cpu_share(Printable(*result.supervisor_cpu_share));
  }
  return message;
}

}  // namespace giveway::fleetctl
