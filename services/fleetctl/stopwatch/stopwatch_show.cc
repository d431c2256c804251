#include "services/fleetctl/stopwatch/stopwatch_show.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/runtime/json.h"

namespace giveway::fleetctl {
namespace {

std::string_view DutyName(Duty duty) {
  switch (duty) {
    case Duty::kMust:
      return "must";
    case Duty::kNone:
      return "none";
    default:
      return "may";
  }
}

std::string_view Name(LivelinessKind kind) {
  switch (kind) {
    case LivelinessKind::kAutomatic:
      return "AUTOMATIC";
    case LivelinessKind::kManualByParticipant:
      return "MANUAL_BY_PARTICIPANT";
    case LivelinessKind::kManualByTopic:
      return "MANUAL_BY_TOPIC";
  }
  return "";
}

std::string MillisecondsText(Nanoseconds time) { return fmt::format("{:.1f}", Milliseconds(time)); }

std::string Row(const Cell& cell) {
  std::string row =
      fmt::format("  {:<8} {:<11} {:<5} {:>6} {:>10}", Name(cell.fault), Name(cell.mechanism),
                  DutyName(cell.duty), cell.trials, fmt::format("{}/{}", cell.seen.n, cell.asked));
  for (const Nanoseconds time : {cell.seen.min, cell.seen.p50, cell.seen.p99, cell.seen.max}) {
    row += fmt::format(" {:>8}", cell.seen.n == 0 ? "-" : MillisecondsText(time));
  }
  const bool must = cell.duty == Duty::kMust;
  row += fmt::format(" {:>9} {:>7}", must ? MillisecondsText(cell.promised) : "-",
                     must ? MillisecondsText(cell.longest_pause) : "-");
  row += fmt::format(" {:>7}", must ? std::to_string(cell.excused) : "-");
  return row + (cell.Kept() ? "  kept" : "  BROKEN");
}

std::string FindingOf(const Cell& cell) {
  std::string text = fmt::format("{}: {}", Name(cell.fault), Name(cell.mechanism));
  if (cell.uncalled_for > 0) {
    return text + fmt::format(" must not see it, and was seen {} times", cell.uncalled_for);
  }
  if (cell.unseen > 0) text += fmt::format(" did not see {} of {}", cell.unseen, cell.asked);
  if (cell.unseen > 0 && cell.late > 0) text += " and";
  if (cell.late > 0) {
    text += fmt::format(
        " saw {} of {} later than the {:.0f} ms promised and the pause then, by up "
        "to {:.1f} ms",
        cell.late, cell.asked, Milliseconds(cell.promised), Milliseconds(cell.worst_excess));
  }
  return text;
}

// Known behaviour of this library, if it is the likely reason.
std::string MaskingHint(const StopwatchReport& report) {
  const bool masked = std::ranges::any_of(report.cells, [](const Cell& cell) {
    return cell.mechanism == Mechanism::kLiveliness && !cell.Kept();
  });
  if (!masked || report.limits.tracked == LivelinessKind::kManualByTopic) return {};
  if (report.library_major >= 3) return {};
  return fmt::format(
      "Readers track liveliness as {}: Fast DDS 2.9.1 lets any living participant refresh a dead "
      "one, until the "
      "dead one's lease is over. Take MANUAL_BY_TOPIC for writer and reader.",
      Name(report.limits.tracked));
}

std::string_view Name(StopwatchVerdict verdict) {
  switch (verdict) {
    case StopwatchVerdict::kKept:
      return "kept";
    case StopwatchVerdict::kBroken:
      return "broken";
    case StopwatchVerdict::kIncomplete:
      return "incomplete";
    case StopwatchVerdict::kNotRun:
      return "not_run";
  }
  return "";
}

std::string_view Sentence(StopwatchVerdict verdict) {
  switch (verdict) {
    case StopwatchVerdict::kKept:
      return "every promise was kept";
    case StopwatchVerdict::kBroken:
      return "not every promise was kept";
    case StopwatchVerdict::kIncomplete:
      return "not every trial could be made";
    case StopwatchVerdict::kNotRun:
      return "NOT RUN: no trial could be made";
  }
  return "";
}

Json JsonOfTerm(const Term& term) {
  Json one;
  one["ms"] = Milliseconds(term.time);
  one["reason"] = term.reason;
  return one;
}

Json JsonOf(const Cell& cell, const Limits& limits) {
  Json json;
  json["fault"] = Name(cell.fault);
  json["mechanism"] = Name(cell.mechanism);
  json["duty"] = DutyName(cell.duty);
  json["trials"] = cell.trials;
  json["asked"] = cell.asked;
  json["seen"] = cell.seen.n;
  if (cell.seen.n > 0) {
    json["min_ms"] = Milliseconds(cell.seen.min);
    json["p50_ms"] = Milliseconds(cell.seen.p50);
    json["p99_ms"] = Milliseconds(cell.seen.p99);
    json["max_ms"] = Milliseconds(cell.seen.max);
  }
  if (cell.duty == Duty::kMust) {
    json["promised_ms"] = Milliseconds(cell.promised);
    json["promise"] = JsonArray(Promise(cell.mechanism, limits), JsonOfTerm);
    json["longest_pause_ms"] = Milliseconds(cell.longest_pause);
    json["unseen"] = cell.unseen;
    json["excused"] = cell.excused;
    json["late"] = cell.late;
    if (cell.late > 0) json["worst_excess_ms"] = Milliseconds(cell.worst_excess);
  }
  if (cell.duty == Duty::kNone) json["uncalled_for"] = cell.uncalled_for;
  json["kept"] = cell.Kept();
  return json;
}

}  // namespace

StopwatchVerdict StopwatchReport::Verdict() const {
  if (!std::ranges::all_of(cells, &Cell::Kept)) return StopwatchVerdict::kBroken;
  if (cells.empty() && !interrupted) return StopwatchVerdict::kNotRun;
  return problems.empty() && !interrupted ? StopwatchVerdict::kKept : StopwatchVerdict::kIncomplete;
}

std::vector<std::string> Findings(const StopwatchReport& report) {
  std::vector<std::string> findings;
  for (const Cell& cell : report.cells) {
    if (!cell.Kept()) findings.push_back(FindingOf(cell));
  }
  const std::string hint = MaskingHint(report);
  if (!hint.empty()) findings.push_back(hint);
  return findings;
}

std::string StopwatchText(const StopwatchReport& report) {
  std::string text = fmt::format(
      "{} vehicles a fleet, {} fleets at a time, {}, seed {}; milliseconds from the fault\n\n"
      "  {:<8} {:<11} {:<5} {:>6} {:>10} {:>8} {:>8} {:>8} {:>8} {:>9} {:>7} {:>7}\n",
      report.vehicles, report.fleets, report.qos_file, report.seed, "fault", "mechanism", "duty",
      "trials", "seen", "min", "p50", "p99", "max", "promised", "+pause", "excused");
  for (const Cell& cell : report.cells) text += Row(cell) + "\n";
  text += "\npromised, each with the longest pause until then on top:\n";
  for (std::size_t i = 0; i < kMechanisms; ++i) {
    const auto mechanism = static_cast<Mechanism>(i);
    std::string sum;
    for (const Term& term : Promise(mechanism, report.limits)) {
      sum += fmt::format("{}{:.0f} ms ({})", sum.empty() ? "" : " + ", Milliseconds(term.time),
                         term.reason);
    }
    text += fmt::format("  {:<11} {}\n", Name(mechanism), sum.empty() ? "off" : sum);
  }
  for (const std::string& finding : Findings(report)) text += "\nBROKEN " + finding;
  for (const std::string& problem : report.problems) text += "\nnot tried: " + problem;
  return text + fmt::format("\n{} after {:.0f} s; {} false alarms\n", Sentence(report.Verdict()),
                            report.took_s, report.false_alarms);
}

std::string StopwatchJson(const StopwatchReport& report) {
  Json json;
  json["verdict"] = Name(report.Verdict());
  json["qos"] = report.qos_file;
  json["liveliness_asserted"] = Name(report.limits.asserted);
  json["liveliness_tracked"] = Name(report.limits.tracked);
  json["vehicles"] = report.vehicles;
  json["fleets"] = report.fleets;
  json["seed"] = report.seed;
  json["took_s"] = report.took_s;
  json["false_alarms"] = report.false_alarms;
  json["findings"] = Findings(report);
  json["not_tried"] = report.problems;
  json["cells"] =
      JsonArray(report.cells, [&](const Cell& cell) { return JsonOf(cell, report.limits); });
  return JsonText(std::move(json)) + "\n";
}

}  // namespace giveway::fleetctl
