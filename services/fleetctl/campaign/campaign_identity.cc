#include "services/fleetctl/campaign/campaign_identity.h"

#include <fmt/format.h>

#include <cstdint>

#include "services/fleetctl/output/shell_word.h"
#include "services/types/state_hash.h"

namespace giveway::fleetctl {
namespace {

template <typename Range>
std::string RangeText(const Range& range) {
  return range.low == range.high ? fmt::format("{}", range.low)
                                 : fmt::format("{}..{}", range.low, range.high);
}

}  // namespace

std::string HashOf(std::string_view bytes) {
  StateHash hash;
  for (const char c : bytes) hash.Add(std::uint64_t{static_cast<unsigned char>(c)});
  return fmt::format("{:016x}", hash.Value());
}

std::string CanonicalText(const CampaignPlan& plan) {
  std::string text = fmt::format("campaign {}\n", plan.name);
  for (const std::string& generator : plan.generators) {
    text += fmt::format("generator {}\n", generator);
  }
  if (plan.vehicles)
    text += fmt::format("vehicles {}..{}\n", plan.vehicles->low, plan.vehicles->high);
  if (plan.duration_s) text += fmt::format("duration {}\n", *plan.duration_s);
  text += fmt::format("seeds {}..{}\nloss {}..{}\nburst {:d}\n", plan.seeds.low, plan.seeds.high,
                      plan.loss_percent.low, plan.loss_percent.high, plan.burst);
  text +=
      fmt::format("delay {}\njitter {}\nreorder {}\nduplicate {}\nloopback {:d}\n", plan.delay_ms,
                  plan.jitter_ms, plan.reorder_percent, plan.duplicate_percent, plan.loops_back);
  text += fmt::format("crashes {}\npauses {}\nrestarts {}\nskip_unsupported {:d}\n", plan.crashes,
                      plan.pauses, plan.restarts, plan.skip_unsupported);
  // With its length, so that a text cannot be taken for a part of the next.
  text += fmt::format("scenario {}\n{}\n", plan.scenario_text.size(), plan.scenario_text);
  return text + fmt::format("faults {}\n{}", plan.fault_file, plan.fault_text);
}

std::string PlanHash(const CampaignPlan& plan) { return HashOf(CanonicalText(plan)); }

std::string FlagsOf(const CampaignPlan& plan) {
  std::string flags;
  if (plan.vehicles) flags += " --vehicles " + RangeText(*plan.vehicles);
  if (plan.duration_s) flags += fmt::format(" --duration {}", *plan.duration_s);
  const auto add = [&](const char* flag, double value) {
    if (value > 0) flags += fmt::format(" {} {}", flag, value);
  };
  if (plan.loss_percent.high > 0) flags += " --loss " + RangeText(plan.loss_percent);
  if (plan.burst) flags += " --burst";
  add("--delay", plan.delay_ms);
  add("--jitter", plan.jitter_ms);
  add("--reorder", plan.reorder_percent);
  add("--duplicate", plan.duplicate_percent);
  if (plan.loops_back) flags += " --loopback";
  add("--crashes", plan.crashes);
  add("--pauses", plan.pauses);
  add("--restarts", plan.restarts);
  if (!plan.fault_file.empty()) flags += " --faults " + ShellWord(plan.fault_file);
  if (plan.skip_unsupported) flags += " --skip-unsupported";
  return flags;
}

}  // namespace giveway::fleetctl
