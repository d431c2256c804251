#include "services/fleetctl/qos/qos_apply_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/fleetctl/output/finding_text.h"
#include "services/runtime/json.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

std::string Name(ApplyVerdict verdict) {
  switch (verdict) {
    case ApplyVerdict::kApplied:
      return "applied";
    case ApplyVerdict::kNothingToDo:
      return "nothing_to_do";
    case ApplyVerdict::kDryRun:
      return "dry_run";
    case ApplyVerdict::kRefused:
      return "refused";
    case ApplyVerdict::kRolledBack:
      return "rolled_back";
    case ApplyVerdict::kNotRolledBack:
      return "not_rolled_back";
    case ApplyVerdict::kNotSeen:
      break;
  }
  return "not_seen";
}

std::string Name(qos::Effect effect) { return effect == qos::Effect::kNow ? "now" : "restart"; }

std::string Or(const std::string& text, const char* instead) {
  return text.empty() ? instead : text;
}

std::string LineOf(const qos::Change& change) {
  return fmt::format("  {:<24} {:<24} {} -> {}  ({})\n", change.profile, change.what,
                     Or(change.from, "not there"), Or(change.to, "not there"), Name(change.effect));
}

std::string ChangesText(const std::vector<qos::Change>& changes) {
  std::string text;
  for (const qos::Change& change : changes) text += LineOf(change);
  return text.empty() ? "  nothing changes\n" : text;
}

Json JsonOf(const qos::Change& change) {
  Json object;
  object["profile"] = change.profile;
  object["what"] = change.what;
  object["from"] = change.from;
  object["to"] = change.to;
  object["effect"] = Name(change.effect);
  return object;
}

Json JsonOf(const AppliedTo& applied) {
  Json object;
  object["id"] = Number(applied.vehicle);
  object["process"] = NameOf(applied.vehicle);
  object["before"] = applied.before;
  object["in_effect"] = applied.in_effect;
  object["refusal"] = applied.refusal;
  object["seconds"] = applied.seconds;
  object["checked"] = applied.checked;
  object["seen"] = applied.seen;
  object["changes"] =
      JsonArray(applied.changes, [](const qos::Change& one) { return JsonOf(one); });
  return object;
}

Json JsonOf(const ServiceFigures& figures) {
  Json object;
  object["alarms"] = figures.alarms;
  object["lost"] = figures.lost;
  object["taken"] = figures.taken;
  object["pair_seconds"] = figures.pair_seconds;
  return object;
}

Json JsonOf(const CanaryTrial& trial) {
  Json object;
  object["vehicle"] = Number(trial.vehicle);
  object["seconds"] = trial.seconds;
  object["canary"] = JsonOf(trial.canary);
  object["rest"] = JsonOf(trial.rest);
  object["worse"] = trial.worse;
  return object;
}

std::string FiguresText(const ServiceFigures& figures) {
  return fmt::format("{:.0f} alarms a peer and hour, {:.1f} % of beacons lost",
                     figures.AlarmsPerPairHour(), 100 * figures.LostShare());
}

// Null if it says nothing of it.
const LiveValue* LiveOf(const AdminAnswer& answer, const qos::Change& change) {
  const auto live = std::ranges::find_if(answer.live, [&](const LiveValue& value) {
    return value.profile == change.profile && value.policy == change.what;
  });
  return live == answer.live.end() ? nullptr : &*live;
}

}  // namespace

void HoldAgainstChanges(const AdminAnswer& before, const AdminAnswer& now, AppliedTo* applied) {
  for (const qos::Change& change : applied->changes) {
    const LiveValue* const live = LiveOf(now, change);
    if (live == nullptr) continue;
    const LiveValue* const had = LiveOf(before, change);
    const bool by_code = had != nullptr && had->number != change.before;
    const bool as_wanted =
        live->number == change.number || (by_code && live->number == had->number);
    ++applied->checked;
    applied->seen += as_wanted ? 1 : 0;
  }
}

std::string NameOf(VehicleId process) {
  return process == kNoVehicle ? "the world" : fmt::format("vehicle {}", Number(process));
}

int ExitCode(ApplyVerdict verdict) {
  return verdict == ApplyVerdict::kApplied || verdict == ApplyVerdict::kNothingToDo ||
                 verdict == ApplyVerdict::kDryRun
             ? 0
             : 1;
}

std::string PlanText(const ApplyReport& report) {
  std::vector<std::pair<std::string, std::string>>
      groups;  // changes, and the vehicles that have them
  for (const AppliedTo& applied : report.vehicles) {
    const std::string changes =
        fmt::format(": {} -> {}\n", Printable(applied.before), report.profile) +
        ChangesText(applied.changes);
    auto group = std::ranges::find(groups, changes, &std::pair<std::string, std::string>::first);
    const bool is_world = applied.vehicle == kNoVehicle;
    if (group == groups.end()) group = groups.insert(group, {changes, is_world ? "" : "vehicle"});
    group->second += is_world ? "the world" : fmt::format(" {}", Number(applied.vehicle));
  }
  std::string text;
  for (const auto& [changes, whose] : groups) text += whose + changes;
  // If no intermediate set is needed, the order is that of the command line.
  const auto is_between = [](const std::string& step) { return step.ends_with(")"); };
  if (std::ranges::any_of(report.order, is_between)) {
    text += fmt::format("in this order: {}\n", fmt::join(report.order, ", "));
  }
  return text;
}

std::string LineOf(const AppliedTo& applied) {
  if (!applied.in_effect) {
    return fmt::format("{}: {}\n", NameOf(applied.vehicle), Printable(applied.refusal));
  }
  return fmt::format("{}: in effect after {:.2f} s{}; {} of {} values seen in it\n",
                     NameOf(applied.vehicle), applied.seconds,
                     qos::NeedsRestart(applied.changes) ? ", restarted" : "", applied.seen,
                     applied.checked);
}

std::string BetweenLine(const AppliedTo& applied) {
  return fmt::format("{}: has the set between after {:.2f} s\n", NameOf(applied.vehicle),
                     applied.seconds);
}

std::string LineOf(const CanaryTrial& trial) {
  return fmt::format("vehicle {} for {:.1f} s: {}\nthe rest: {}\n{}\n", Number(trial.vehicle),
                     trial.seconds, FiguresText(trial.canary), FiguresText(trial.rest),
                     trial.worse.empty() ? "no worse: promoted" : "worse: " + trial.worse);
}

std::string LineOf(const ApplyReport& report) {
  switch (report.verdict) {
    case ApplyVerdict::kRefused: {
      std::string text;
      for (const qos::Finding& finding : report.findings) text += ToText(finding);
      return text + (report.remedy.empty() ? "refused\n" : "refused: " + report.remedy + "\n");
    }
    case ApplyVerdict::kRolledBack:
      return fmt::format("rolled back: vehicle {} runs with {} again\n",
                         Number(report.trial->vehicle), report.vehicles.front().before);
    case ApplyVerdict::kNotRolledBack:
      return fmt::format(
          "NOT rolled back: vehicle {} did not say that it runs with {} again; see its log\n",
          Number(report.trial->vehicle), Printable(report.vehicles.front().before));
    case ApplyVerdict::kNotSeen:
      return "a process says it is in effect, and its endpoints run with other values\n";
    case ApplyVerdict::kNothingToDo:
      return "every process named runs with it already\n";
    case ApplyVerdict::kDryRun:
      return "nothing was changed (--dry-run)\n";
    case ApplyVerdict::kApplied:
      break;
  }
  const auto vehicles = std::ranges::count_if(
      report.vehicles, [](const AppliedTo& applied) { return applied.vehicle != kNoVehicle; });
  const bool world = static_cast<std::size_t>(vehicles) < report.vehicles.size();
  return fmt::format(
      "a process keeps it until it is started from outside, as after a crash, and may then match\n"
      "no other: set its --qos or GIVEWAY_QOS to {}, too\n"
      "{} in effect on {} vehicle{}{}\n",
      report.profile, report.profile, vehicles, vehicles == 1 ? "" : "s",
      world ? " and the world" : "");
}

std::string ToJson(const ApplyReport& report) {
  Json object;
  object["profile"] = report.profile;
  object["verdict"] = Name(report.verdict);
  object["vehicles"] = JsonArray(report.vehicles, [](const AppliedTo& one) { return JsonOf(one); });
  object["order"] = report.order;
  if (report.trial) object["trial"] = JsonOf(*report.trial);
  object["findings"] = ToJson(report.findings);
  if (!report.remedy.empty()) object["remedy"] = report.remedy;
  return JsonText(std::move(object)) + "\n";
}

}  // namespace giveway::fleetctl
