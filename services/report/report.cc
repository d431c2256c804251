#include "services/report/report.h"

#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <optional>

#include "report.pb.h"
#include "services/report/violations.h"
#include "services/runtime/utf8.h"
#include "services/types/check.h"

namespace giveway {
namespace {

schema::Report::Verdict ToSchema(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassed:
      return schema::Report::passed;
    case Verdict::kFailed:
      return schema::Report::failed;
    case Verdict::kNotRun:
      return schema::Report::not_run;
  }
  return schema::Report::not_run;
}

// The value to print: micrometres, microseconds and nanoseconds, so that no digit is noise. JSON
// has no word for nan and inf: such a value does not exist.
std::optional<double> Printed(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return std::round(*value * 1e6) / 1e6;
}

void SetReaction(const Report& report, schema::Report* message) {
  if (const auto p50 = Printed(report.reaction_p50_ms))
    message->mutable_reaction_ms()->set_p50(*p50);
  if (const auto p99 = Printed(report.reaction_p99_ms))
    message->mutable_reaction_ms()->set_p99(*p99);
  if (const auto max = Printed(report.reaction_max_ms))
    message->mutable_reaction_ms()->set_max(*max);
}

void SetInvariants(const Report& report, schema::Report* message) {
  if (!report.violations.empty()) {
    SetViolations(report.violations, message->mutable_violations());
  }
  for (const FirstViolation& first : report.first_violations) {
    schema::Violation& violation = *message->add_first_violations();
    violation.set_invariant(first.invariant);
    violation.set_tick(Number(first.tick));
    violation.set_vehicle(Number(first.vehicle));
    violation.set_other(Number(first.other));
  }
  message->set_ticks_judged(report.ticks_judged);
  message->set_ticks_unseen(report.ticks_unseen);
}

schema::Report ToSchema(const Report& report) {
  schema::Report message;
  message.set_scenario(WellFormed(report.scenario));
  message.set_verdict(ToSchema(report.verdict));
  message.set_reason(WellFormed(report.reason));
  message.set_contacts(report.contacts);
  if (const auto separation_m = Printed(report.min_separation_m)) {
    message.set_min_separation_m(*separation_m);
  }
  if (const auto clear_s = Printed(report.time_to_clear_s)) message.set_time_to_clear_s(*clear_s);
  for (const VehicleId id : report.halted) message.add_halted(Number(id));
  for (const VehicleId id : report.arrived) message.add_arrived(Number(id));
  message.set_beacons_sent(static_cast<double>(report.beacons_sent));
  message.set_beacons_received(static_cast<double>(report.beacons_received));
  message.set_deadline_missed(static_cast<double>(report.deadline_missed));
  message.set_liveliness_lost(static_cast<double>(report.liveliness_lost));
  SetTrust(report.trust, message.mutable_trust());
  SetReaction(report, &message);
  message.set_tick_overruns(report.tick_overruns);
  message.set_seed(report.seed);
  message.set_domain(report.domain);
  message.set_state_hash(WellFormed(report.state_hash));
  SetInvariants(report, &message);
  return message;
}

}  // namespace

std::string ToJson(const Report& report) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(ToSchema(report), &json, options);
  GIVEWAY_CHECK(status.ok(), status.ToString());
  return json;
}

int ExitCode(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassed:
      return 0;
    case Verdict::kFailed:
      return 1;
    case Verdict::kNotRun:
      return 2;
  }
  return 2;
}

}  // namespace giveway
