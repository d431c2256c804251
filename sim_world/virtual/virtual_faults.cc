#include "sim_world/virtual/virtual_faults.h"

#include <optional>

#include "services/faults/kind_table.h"
#include "services/faults/unsupported.h"
#include "services/types/state_hash.h"

namespace giveway::sim {
namespace {

using faults::Kind;
using What = faults::Target::What;

std::optional<ProcessFaultKind> ProcessKindOf(Kind kind) {
  switch (kind) {
    case Kind::kKill:
      return ProcessFaultKind::kCrash;
    case Kind::kRestart:
      return ProcessFaultKind::kRestart;
    case Kind::kPause:
    case Kind::kHang:  // whatever of the process still runs, its vehicle receives and sends nothing
      return ProcessFaultKind::kPause;
    case Kind::kSlow:
      return ProcessFaultKind::kSlow;
    default:
      return std::nullopt;
  }
}

// The rule is of one hearer, or of every vehicle.
RadioRule RadioRuleOf(const faults::Fault& fault) {
  const faults::Parameters with = faults::Filled(fault.kind, fault.parameters);
  RadioRule rule{.from_s = fault.at_s,
                 .to_s = fault.EndsAt_s(),
                 .hearer = fault.target.what == What::kAll ? kNoVehicle : fault.target.vehicle,
                 .draws = DrawsOf(fault)};
  const double share = with.probability.value_or(0);
  const Nanoseconds late = FromSeconds(with.delay_s.value_or(0));
  switch (fault.kind) {
    case Kind::kLoss:
      rule.loss = share;
      break;
    case Kind::kBurst:
      rule.burst_loss = share;
      rule.burst_ticks = with.count.value_or(1);
      break;
    case Kind::kDelay:
      rule.delay = late;
      break;
    case Kind::kReorder:
      rule.reorder = share;
      rule.reorder_by = late;
      break;
    case Kind::kDuplicate:
      rule.duplicate = share;
      break;
    case Kind::kOneWayCut:
      rule.cut = true;
      rule.speaker = with.from.value_or(kNoVehicle);
      break;
    case Kind::kPartition:
    case Kind::kFlapping:
      rule.cut = true;
      rule.both_ways = true;
      rule.period_s = with.period_s.value_or(0);
      break;
    default:
      break;
  }
  return rule;
}

void AddProcessFaults(const faults::Fault& fault, ProcessFaultKind kind, const Scenario& scenario,
                      std::vector<ProcessFault>* processes) {
  const faults::Parameters with = faults::Filled(fault.kind, fault.parameters);
  for (const VehicleOptions& options : scenario.vehicles) {
    if (fault.target.what != What::kAll && fault.target.vehicle != options.id) continue;
    processes->push_back({.kind = kind,
                          .vehicle = options.id,
                          .at_s = fault.at_s,
                          .for_s = fault.for_s,
                          .share = with.share.value_or(1)});
  }
}

}  // namespace

std::uint64_t DrawsOf(const faults::Fault& fault) {
  StateHash hash;
  for (const char letter : fault.rule) hash.Add(std::uint64_t{static_cast<unsigned char>(letter)});
  hash.Add(fault.nth);
  return hash.Value();
}

VirtualPlan Translated(const VirtualPlan& plan, const Scenario& scenario) {
  VirtualPlan translated = plan;
  translated.schedule = faults::Without(plan.schedule, faults::IncapableInVirtualTime());
  for (const faults::Fault& fault : translated.schedule) {
    if (const auto kind = ProcessKindOf(fault.kind)) {
      AddProcessFaults(fault, *kind, scenario, &translated.faults);
    } else if (faults::ActorOf(fault.kind) == faults::Actor::kHearer) {
      translated.radio.rules.push_back(RadioRuleOf(fault));
    }
  }
  return translated;
}

}  // namespace giveway::sim
