#include "services/report/virtual_report.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cmath>

#include "report.pb.h"
#include "services/report/violations.h"
#include "services/runtime/utf8.h"
#include "services/types/check.h"

namespace giveway {
namespace {

schema::Report::Verdict SchemaOf(Verdict verdict) {
  if (verdict == Verdict::kPassed) return schema::Report::passed;
  return verdict == Verdict::kFailed ? schema::Report::failed : schema::Report::not_run;
}

double Rounded(double value) { return std::round(value * 1e6) / 1e6; }

void SetTraffic(const TrafficReport& traffic, schema::Traffic* message) {
  for (const auto& [rule, mean_s] : traffic.by_rule_s) {
    schema::RuleTime& time = *message->add_by_rule();
    time.set_rule(rule);
    time.set_mean_s(Rounded(mean_s));
  }
  message->set_stops(Rounded(traffic.stops));
  message->set_taken_back(Rounded(traffic.taken_back));
}

schema::VirtualReport ToSchema(const VirtualReport& report) {
  schema::VirtualReport message;
  message.set_scenario(WellFormed(report.scenario));
  message.set_verdict(SchemaOf(report.verdict));
  message.set_reason(WellFormed(report.reason));
  message.set_runs(report.runs);
  message.set_failed_runs(report.failed_runs);
  message.set_contacts(report.contacts);
  SetViolations(report.violations, message.mutable_violations());
  for (const SeedViolation& first : report.first_violations) {
    schema::Violation& violation = *message.add_first_violations();
    violation.set_invariant(first.what.invariant);
    violation.set_tick(Number(first.what.tick));
    violation.set_vehicle(Number(first.what.vehicle));
    violation.set_other(Number(first.what.other));
    violation.set_seed(first.seed);
    violation.set_time_s(Rounded(first.time_s));
    violation.set_rule(first.rule);
  }
  message.set_vehicles(report.vehicles);
  message.set_arrived(report.arrived);
  if (!report.unmet.empty()) message.set_unmet(WellFormed(report.unmet));
  message.set_vehicle_hours(Rounded(report.vehicle_hours));
  message.set_vehicle_hours_per_minute(Rounded(report.vehicle_hours_per_minute));
  if (report.delay_p50_s) message.mutable_delay_s()->set_p50(Rounded(*report.delay_p50_s));
  if (report.delay_p99_s) message.mutable_delay_s()->set_p99(Rounded(*report.delay_p99_s));
  if (report.delay_mean_s) message.mutable_delay_s()->set_mean(Rounded(*report.delay_mean_s));
  if (report.min_separation_m) message.set_min_separation_m(Rounded(*report.min_separation_m));
  SetTraffic(report.traffic, message.mutable_traffic());
  SetTrust(report.trust, message.mutable_trust());
  message.set_hash(report.hash);
  for (const std::uint32_t seed : report.failing_seeds) message.add_failing_seeds(seed);
  message.set_jobs(report.jobs);
  return message;
}

// "seed 3, 12.35 s (tick 247): contact, vehicle 4 with 7, cruise".
std::string LineOf(const SeedViolation& first) {
  std::string line =
      fmt::format("  seed {}, {:.2f} s (tick {}): {}, vehicle {}", first.seed, first.time_s,
                  Number(first.what.tick), first.what.invariant, Number(first.what.vehicle));
  if (first.what.other != kNoVehicle) line += fmt::format(" with {}", Number(first.what.other));
  return line + fmt::format(", {}\n", first.rule);
}

std::string_view VerdictWord(Verdict verdict) {
  if (verdict == Verdict::kPassed) return "passed";
  return verdict == Verdict::kFailed ? "FAILED" : "not run";
}

}  // namespace

std::string ToJson(const VirtualReport& report) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(ToSchema(report), &json, options);
  GIVEWAY_CHECK(status.ok(), status.ToString());
  return json;
}

std::string ToText(const VirtualReport& report) {
  constexpr std::size_t kLines = 20;
  std::string text =
      fmt::format("{}: {}, {}\n", report.scenario, VerdictWord(report.verdict), report.reason);
  text += fmt::format("  runs {}, failed {}, contacts {}\n", report.runs, report.failed_runs,
                      report.contacts);
  for (const BrokenInvariant& broken : report.violations) {
    if (broken.count > 0) text += fmt::format("  {} broken {} times\n", broken.name, broken.count);
  }
  for (std::size_t i = 0; i < std::min(kLines, report.first_violations.size()); ++i) {
    text += LineOf(report.first_violations[i]);
  }
  if (report.first_violations.size() > kLines) {
    text += fmt::format("  and {} more in --json\n", report.first_violations.size() - kLines);
  }
  if (!report.unmet.empty()) text += fmt::format("  {}\n", report.unmet);
  text += fmt::format("  arrived {} of {} vehicles\n", report.arrived, report.vehicles);
  text += fmt::format("  {:.2f} vehicle-hours, {:.1f} a minute\n", report.vehicle_hours,
                      report.vehicle_hours_per_minute);
  if (report.delay_p50_s && report.delay_p99_s && report.delay_mean_s) {
    text += fmt::format("  delay: mean {:.1f} s, median {:.1f} s, 99 % below {:.1f} s\n",
                        *report.delay_mean_s, *report.delay_p50_s, *report.delay_p99_s);
  }
  text += fmt::format(
      "  did not fit: {} beacons without echo, {} halted but closing, {} jumps, "
      "{} impossible speeds; {} echoes without beacon\n",
      report.trust.beacon_without_echo, report.trust.halted_but_closing, report.trust.jumps,
      report.trust.impossible_speeds, report.trust.echo_without_beacon);
  if (!report.failing_seeds.empty()) {
    text += "  failing seeds:";
    for (const std::uint32_t seed : report.failing_seeds) text += fmt::format(" {}", seed);
    text += '\n';
  }
  return text + fmt::format("  hash {}\n", report.hash);
}

}  // namespace giveway
