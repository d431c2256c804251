#include "services/config/writing/scenario_write.h"

#include <google/protobuf/text_format.h>

#include <sstream>

#include "scenario.pb.h"
#include "services/config/impair.h"
#include "services/config/scenario_file.h"
#include "services/config/writing/place_write.h"
#include "services/config/writing/vehicle_write.h"
#include "services/types/check.h"

namespace giveway {
namespace {

void Set(const PlannedFault& fault, schema::Fault* message) {
  if (fault.kind == FaultKind::kKill) message->set_kill(Number(fault.vehicle));
  if (fault.kind == FaultKind::kSignalDark) message->set_dark(Number(fault.signal));
  if (fault.kind == FaultKind::kSignalSilent) message->set_silent(Number(fault.signal));
  if (fault.at_s) message->set_at_s(*fault.at_s);
  if (fault.before_crossing_m) message->set_before_crossing_m(*fault.before_crossing_m);
}

// Numbers that are as without the rule are left out.
void SetNumbers(const ImpairmentRule& rule, google::protobuf::Message* message) {
  const ImpairmentRule plain;
  for (const ImpairField& field : ImpairFields()) {
    const double value = rule.*field.member;
    if (value == plain.*field.member) continue;
    const auto* written = message->GetDescriptor()->FindFieldByName(std::string(field.field));
    GIVEWAY_CHECK(written != nullptr, field.field);
    message->GetReflection()->SetDouble(message, written, value * field.per_si);
  }
}

void Set(const ImpairmentRule& rule, schema::Impair* message) {
  if (rule.from == ImpairedSender::kOneVehicle) {
    message->set_from_vehicle(Number(rule.from_vehicle));
  } else if (rule.from != ImpairedSender::kAnyone) {
    message->set_from(static_cast<schema::ImpairedSender>(rule.from));
  }
  if (rule.to_vehicle != kNoVehicle) message->set_to_vehicle(Number(rule.to_vehicle));
  SetNumbers(rule, message);
  if (rule.from_s) message->set_from_s(*rule.from_s);
  if (rule.to_s) message->set_to_s(*rule.to_s);
  for (const Blackout& blackout : rule.blackouts) {
    schema::Blackout* written = message->add_blackout();
    written->set_from_s(blackout.from_s);
    written->set_to_s(blackout.to_s);
  }
}

void SetExpectation(const Expectation& expect, schema::Expect* message) {
  message->set_contacts(expect.contacts);
  message->set_any_halted(expect.any_halted);
  if (expect.any_arrived) message->set_any_arrived(true);
  if (expect.parted) message->set_parted(true);
  if (expect.min_separation_m) message->set_min_separation_m(*expect.min_separation_m);
  if (expect.time_to_clear_s) message->set_time_to_clear_s(*expect.time_to_clear_s);
  if (expect.halted_for) {
    schema::Reason reason = schema::give_way;
    GIVEWAY_CHECK(schema::Reason_Parse(std::string(Name(*expect.halted_for)), &reason));
    message->set_halted_for(reason);
  }
  for (const VehicleId id : expect.halted) message->add_halted(Number(id));
  for (const VehicleId id : expect.arrived) message->add_arrived(Number(id));
}

// What all vehicles share stands in each of them.
const VehicleOptions* AnyOf(const Scenario& scenario) {
  if (!scenario.vehicles.empty()) return &scenario.vehicles.front();
  return scenario.spawns.empty() ? nullptr : &scenario.spawns.front();
}

schema::Scenario ToSchema(const Scenario& scenario) {
  schema::Scenario message;
  message.set_name(scenario.name);
  message.set_description(scenario.description);
  if (scenario.area != Scenario().area) message.set_area(scenario.area);
  message.set_tick_period_ms(Milliseconds(scenario.tick_period));
  message.set_duration_s(scenario.duration_s);
  message.set_start_timeout_s(scenario.start_timeout_s);
  message.set_remove_after_s(scenario.remove_after_s);
  message.set_watchdog_ticks(scenario.watchdog_ticks);
  if (const VehicleOptions* const any = AnyOf(scenario)) {
    const VehicleOptions& options = *any;
    message.set_emission_radius_m(options.emission_radius_m);
    message.set_gate_enter_m(options.gate_enter_m);
    message.set_gate_exit_m(options.gate_exit_m);
    message.set_beacon_age_limit_ms(Milliseconds(options.beacon_age_limit));
  }
  SetPlace(scenario, &message);
  for (const VehicleOptions& options : scenario.vehicles) Set(options, message.add_vehicle());
  for (const VehicleOptions& place : scenario.spawns) Set(place, message.add_spawn());
  if (!scenario.spawns.empty()) message.set_start_with(scenario.start_with);
  for (const PlannedFault& fault : scenario.faults) Set(fault, message.add_fault());
  for (const ImpairmentRule& rule : scenario.impairment.rules) Set(rule, message.add_impair());
  if (scenario.impairment.seed) message.set_impair_seed(*scenario.impairment.seed);
  SetExpectation(scenario.expect, message.mutable_expect());
  return message;
}

std::string Commented(const std::string& comment) {
  std::istringstream lines(comment);
  std::string text;
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  return text;
}

}  // namespace

std::string WriteScenario(const Scenario& scenario, const std::string& comment) {
  std::string text;
  GIVEWAY_CHECK(google::protobuf::TextFormat::PrintToString(ToSchema(scenario), &text));
  return Commented(comment) + text;
}

Scenario ReadBack(const Scenario& scenario) {
  return ParseScenario(scenario.name, WriteScenario(scenario, ""));
}

}  // namespace giveway
