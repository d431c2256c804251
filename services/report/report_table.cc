#include <fmt/format.h>
#include <utf8.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "services/report/report.h"
#include "services/runtime/utf8.h"

namespace giveway {
namespace {

using Row = std::pair<std::string, std::string>;

constexpr std::size_t kLeastColumns = 24;
constexpr std::size_t kMostColumns = 78;  // wider lines are hard to read
constexpr const char* kNone = "-";

std::string Word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassed:
      return "PASSED";
    case Verdict::kFailed:
      return "FAILED";
    case Verdict::kNotRun:
      return "NOT RUN";
  }
  return "NOT RUN";
}

std::string Ids(const std::vector<VehicleId>& ids) {
  std::vector<std::uint32_t> numbers;
  for (const VehicleId id : ids) numbers.push_back(Number(id));
  return ids.empty() ? "none" : fmt::format("{}", fmt::join(numbers, ", "));
}

std::string Measure(const std::optional<double>& value, int digits, const char* unit) {
  if (!value || !std::isfinite(*value)) return kNone;
  return fmt::format("{:.{}f} {}", *value, digits, unit);
}

std::string Reaction(const Report& report) {
  if (!report.reaction_p50_ms && !report.reaction_p99_ms && !report.reaction_max_ms) return kNone;
  return fmt::format("p50 {}, p99 {}, max {}", Measure(report.reaction_p50_ms, 1, "ms"),
                     Measure(report.reaction_p99_ms, 1, "ms"),
                     Measure(report.reaction_max_ms, 1, "ms"));
}

std::string Invariants(const Report& report) {
  if (report.ticks_judged == 0) return "not judged: no vehicle was seen";
  const std::string over =
      fmt::format("over {} ticks, {} not seen whole", report.ticks_judged, report.ticks_unseen);
  if (report.first_violations.empty()) return "all held " + over;
  const FirstViolation& first = report.first_violations.front();
  std::string text =
      fmt::format("BROKEN {}; first {} at tick {}", over, first.invariant, Number(first.tick));
  if (first.vehicle != kNoVehicle) text += fmt::format(", vehicle {}", Number(first.vehicle));
  if (first.other != kNoVehicle) text += fmt::format(" with {}", Number(first.other));
  return text;
}

std::vector<Row> Rows(const Report& report) {
  return {
      {"contacts", fmt::format("{}", report.contacts)},
      {"closest", Measure(report.min_separation_m, 3, "m shell to shell")},
      {"halted", Ids(report.halted)},
      {"arrived", Ids(report.arrived)},
      {"clear after", Measure(report.time_to_clear_s, 2, "s")},
      {"reaction", Reaction(report)},
      {"beacons",
       fmt::format("{} sent, {} received", report.beacons_sent, report.beacons_received)},
      {"QoS events", fmt::format("{} deadlines missed, {} liveliness lost", report.deadline_missed,
                                 report.liveliness_lost)},
      {"invariants", Invariants(report)},
      {"overruns", fmt::format("{} ticks", report.tick_overruns)},
      {"run", fmt::format("seed {}, domain {}", report.seed, report.domain)},
      {"state hash", report.state_hash.empty() ? kNone : report.state_hash},
  };
}

// One column a code point, as terminals show the text that is ours. Of well-formed text.
std::size_t Width(std::string_view text) {
  return static_cast<std::size_t>(utf8::distance(text.begin(), text.end()));
}

// The bytes of the first `columns` code points, which are there.
std::size_t Bytes(std::string_view text, std::size_t columns) {
  auto end = text.begin();
  utf8::advance(end, columns, text.end());
  return static_cast<std::size_t>(end - text.begin());
}

// Breaks at spaces; a word longer than a line is cut.
std::vector<std::string> Wrap(const std::string& words, std::size_t columns) {
  const std::string well_formed = WellFormed(words);
  std::string_view text = well_formed;
  std::vector<std::string> lines;
  while (Width(text) > columns) {
    const std::size_t most = Bytes(text, columns);
    const std::size_t space = text.substr(0, most + 1).rfind(' ');
    const bool at_space = space != std::string_view::npos && space > 0;
    lines.emplace_back(text.substr(0, at_space ? space : most));
    text.remove_prefix(at_space ? space + 1 : most);
  }
  lines.emplace_back(text);
  return lines;
}

std::string Line(const Row& row, std::size_t label, std::size_t columns) {
  std::string text;
  bool first = true;
  for (const std::string& part : Wrap(row.second, columns - label)) {
    text += fmt::format("{:<{}}{}\n", first ? row.first : "", label, part);
    first = false;
  }
  return text;
}

}  // namespace

std::string ToTable(const Report& report, int columns) {
  const std::size_t width = std::min(
      std::max(static_cast<std::size_t>(std::max(columns, 0)), kLeastColumns), kMostColumns);
  const std::vector<Row> rows = Rows(report);
  std::size_t label = 0;
  for (const Row& row : rows) label = std::max(label, Width(row.first) + 2);
  const std::string rule = std::string(width, '-') + "\n";
  std::string text = rule;
  const std::string reason = report.reason.empty() ? "" : ": " + report.reason;
  for (const std::string& line :
       Wrap(fmt::format("{}  {}{}", Word(report.verdict), report.scenario, reason), width)) {
    text += line + "\n";
  }
  text += rule;
  for (const Row& row : rows) text += Line(row, label, width);
  return text + rule;
}

}  // namespace giveway
