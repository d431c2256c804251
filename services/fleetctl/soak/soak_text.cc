// A soak's summary for a terminal.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "services/fleetctl/soak/soak_format.h"
#include "services/fleetctl/soak/soak_page.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

constexpr std::size_t kTextColumns = 78;
constexpr std::size_t kMostListedLines = 10;

// Breaks lines at spaces to at most `columns` bytes; a longer word is cut between code points.
std::vector<std::string> Folded(std::string_view text, std::size_t columns) {
  std::vector<std::string> lines;
  while (text.size() > columns) {
    const std::size_t space = text.substr(0, columns + 1).rfind(' ');
    const bool at_space = space != std::string_view::npos && space > 0;
    std::size_t end = at_space ? space : columns;
    while (!at_space && end > 1 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(at_space ? end + 1 : end);
  }
  lines.emplace_back(text);
  return lines;
}

std::string Entry(const std::string& label, const std::string& text, std::size_t indent) {
  std::string entry;
  for (const std::string& line : Folded(WellFormed(text), kTextColumns - indent)) {
    entry += fmt::format("{:<{}}{}\n", entry.empty() ? label : "", indent, line);
  }
  return entry;
}

std::string HistogramLines(const SoakResult& result) {
  std::string lines;
  for (const SoakHistogram& measured : result.histograms) {
    const auto at = [&measured](double p) {
      return FormatValue(measured.unit, measured.histogram.Quantile(p));
    };
    std::string text = fmt::format("median {}, 99 % {}, max {} of {}", at(0.5), at(0.99),
                                   FormatValue(measured.unit, measured.histogram.Max()),
                                   measured.histogram.Count());
    for (const std::string& budget : FormatBudgets(measured)) text += "; " + budget;
    lines += Entry(measured.name, text, 18);
  }
  return lines;
}

std::string FaultLines(const SoakResult& result) {
  std::string lines;
  for (const FaultSummary& summary : SummariesOf(result.faults)) {
    std::string text = fmt::format("{} of {} seen", summary.observed, summary.planned);
    if (!summary.noticed_s.empty()) {
      text += fmt::format(", noticed {} (latest {}), {} late",
                          FormatSeconds(MedianOf(summary.noticed_s)),
                          FormatSeconds(GreatestOf(summary.noticed_s)), summary.late);
    }
    if (!summary.recovered_s.empty()) {
      text +=
          fmt::format(", recovered {} (latest {})", FormatSeconds(MedianOf(summary.recovered_s)),
                      FormatSeconds(GreatestOf(summary.recovered_s)));
    }
    lines += Entry("  " + summary.kind, text, 22);
  }
  return lines;
}

std::string ViolationLines(const SoakResult& result) {
  std::string lines;
  const std::size_t shown = std::min(result.violations.size(), kMostListedLines);
  for (std::size_t i = 0; i < shown; ++i) {
    const SoakViolation& violation = result.violations[i];
    lines += Entry(fmt::format("  {:.2f} s", violation.time_s),
                   fmt::format("{}: {}{}", violation.invariant, violation.words,
                               violation.fault.empty() ? "" : ", after " + violation.fault),
                   14);
  }
  if (result.violations_counted > shown && shown > 0) {
    lines += fmt::format("  and {} more\n", result.violations_counted - shown);
  }
  return lines;
}

}  // namespace

std::string ToText(const SoakResult& result) {
  const std::string rule(kTextColumns, '-');
  std::string text = rule + "\n";
  text += Entry("", FormatVerdict(result) + "  (" + result.scenario + ")", 0) + rule + "\n";
  for (const SummaryRow& row : SummaryOf(result)) {
    text += Entry(row.label, row.text, 18);
    if (row.label == "faults") text += FaultLines(result);
    if (row.label == "violations") text += ViolationLines(result);
    if (row.label == "narrowest margin") text += HistogramLines(result);
  }
  return text + rule + "\n";
}

}  // namespace giveway::fleetctl
