#include "services/fleetctl/campaign/campaign_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "services/fleetctl/campaign/campaign_identity.h"
#include "services/fleetctl/campaign/campaign_schema.h"
#include "services/fleetctl/output/shell_word.h"
#include "services/report/violations.h"

namespace giveway::fleetctl {
namespace {

double ToMicros(double value) { return std::round(value * 1e6) / 1e6; }

double HoursOf(const CampaignSums& sums) { return static_cast<double>(sums.vehicle_ms) / 3.6e6; }

void WriteFigures(const CampaignSums& sums, schema::CampaignFigures* message) {
  message->set_generator(sums.generator);
  message->set_runs(sums.runs);
  message->set_failed_runs(sums.failed_runs);
  message->set_contacts(sums.contacts);
  SetBroken(sums, message->mutable_violations());
  message->set_vehicle_hours(ToMicros(HoursOf(sums)));
  if (const auto mean = MeanDelay(sums)) {
    message->mutable_delay_s()->set_mean(ToMicros(*mean));
    message->mutable_delay_s()->set_p50(*DelayQuantile(sums, 0.5));
    message->mutable_delay_s()->set_p99(*DelayQuantile(sums, 0.99));
  }
  if (sums.separation_m) message->set_min_separation_m(*sums.separation_m);
  SetTrust(sums.trust, message->mutable_trust());
  message->set_hash(fmt::format("{:016x}", sums.hash));
}

// "contact, order"; "all_held" if none is broken.
std::string Reason(const CampaignSums& all) {
  std::string names;
  for (std::size_t i = 0; i < all.violations.size(); ++i) {
    if (all.violations[i] == 0 || !sim::RequiredInvariants().test(i)) continue;
    names += (names.empty() ? "" : ", ") + std::string(sim::Name(static_cast<sim::Invariant>(i)));
  }
  if (all.unmet > 0) names += names.empty() ? "expectation" : ", expectation";
  return names.empty() ? "all_held" : names;
}

std::string CommandOf(const CampaignResult& result, const CampaignSums& sums, std::uint32_t seed) {
  return fmt::format("fleetctl virtual {} --seed {}{}", ShellWord(sums.generator), seed,
                     result.flags);
}

// Failed runs beyond those whose seeds are kept.
std::uint32_t LeftOut(const CampaignSums& sums) {
  return sums.failed_runs - static_cast<std::uint32_t>(sums.failing_seeds.size());
}

std::string TableRow(const CampaignSums& sums) {
  const auto mean = MeanDelay(sums);
  return fmt::format("{:<12}{:>9}{:>8}{:>10}{:>15.1f}{:>15}\n",
                     sums.generator.empty() ? "all" : sums.generator, sums.runs, sums.failed_runs,
                     sums.contacts, HoursOf(sums), mean ? fmt::format("{:.1f}", *mean) : "");
}

}  // namespace

bool AllHeld(const CampaignResult& result) {
  return std::ranges::all_of(result.generators,
                             [](const CampaignSums& sums) { return sums.failed_runs == 0; });
}

std::string ReportJson(const CampaignResult& result) {
  const CampaignSums all = SumOf(result.generators);
  schema::CampaignReport message;
  message.set_format(kCampaignFormat);
  message.set_campaign(result.campaign);
  message.set_verdict(AllHeld(result) ? schema::Report::passed : schema::Report::failed);
  message.set_reason(Reason(all));
  message.set_plan(result.plan);
  message.set_program(result.program);
  WriteFigures(all, message.mutable_all());
  std::uint32_t left_out = 0;
  for (const CampaignSums& sums : result.generators) {
    WriteFigures(sums, message.add_generators());
    left_out += LeftOut(sums);
    for (const std::uint32_t seed : sums.failing_seeds) {
      schema::CampaignFailure& failure = *message.add_failing();
      failure.set_generator(sums.generator);
      failure.set_seed(seed);
      failure.set_command(CommandOf(result, sums, seed));
    }
  }
  message.set_failing_left_out(left_out);
  return JsonLine(message);
}

std::string ReportText(const CampaignResult& result) {
  const CampaignSums all = SumOf(result.generators);
  std::string text =
      fmt::format("{}: {}, {}\n{:<12}{:>9}{:>8}{:>10}{:>15}{:>15}\n", result.campaign,
                  AllHeld(result) ? "passed" : "FAILED", Reason(all), "generator", "runs", "failed",
                  "contacts", "vehicle-hours", "mean delay, s");
  for (const CampaignSums& sums : result.generators) text += TableRow(sums);
  text += TableRow(all);
  for (const CampaignSums& sums : result.generators) {
    for (const std::uint32_t seed : sums.failing_seeds)
      text += CommandOf(result, sums, seed) + "\n";
    if (LeftOut(sums) > 0)
      text += fmt::format("and {} more of {}\n", LeftOut(sums), sums.generator);
  }
  return text;
}

}  // namespace giveway::fleetctl
