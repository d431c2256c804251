#include "services/fleetctl/soak/soak_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "services/fleetctl/output/html_text.h"
#include "services/fleetctl/soak/soak_format.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

constexpr std::size_t kMostRowsShown = 200;
constexpr std::size_t kRowsUnfolded = 20;

// A table that grows row by row. Cells are escaped here.
class HtmlTable {
 public:
  // A heading that starts with '<' is left-aligned, for text.
  explicit HtmlTable(std::vector<std::string> heads) : heads_(std::move(heads)) {}

  void Row() { rows_.emplace_back(); }
  void Cell(std::string_view text, std::string_view style = "") {
    rows_.back() += fmt::format(
        "<td{}>{}</td>", style.empty() ? "" : fmt::format(" class=\"{}\"", style), HtmlText(text));
  }
  void Count(std::uint64_t count) { Cell(fmt::format("{}", count)); }
  // There are `all` rows; those after the first ones are collapsed.
  std::string Html(std::size_t all) const {
    const std::size_t open = std::min(rows_.size(), kRowsUnfolded);
    std::string html = Part(0, open);
    if (open < rows_.size()) {
      html += fmt::format("<details><summary>{} more</summary>\n{}</details>\n",
                          rows_.size() - open, Part(open, rows_.size()));
    }
    if (all > rows_.size()) {
      html += fmt::format("<p>{} more are in report.json.</p>\n", all - rows_.size());
    }
    return html;
  }

 private:
  std::string Part(std::size_t begin, std::size_t end) const {
    std::string html = "<div class=\"scroll\"><table><tr>";
    for (const std::string& head : heads_) {
      const bool of_text = head.starts_with('<');
      html += (of_text ? "<th class=\"text\">" : "<th>") + HtmlText(head.substr(of_text ? 1 : 0)) +
              "</th>";
    }
    html += "</tr>\n";
    for (std::size_t i = begin; i < end; ++i) html += "<tr>" + rows_[i] + "</tr>\n";
    return html + "</table></div>\n";
  }

  std::vector<std::string> heads_;
  std::vector<std::string> rows_;
};

std::string FormatWho(VehicleId vehicle, VehicleId other) {
  if (vehicle == kNoVehicle) return "-";
  if (other == kNoVehicle) return fmt::format("{}", Number(vehicle));
  return fmt::format("{} and {}", Number(vehicle), Number(other));
}

// Pointers to the items by `key`, at most as many as are shown.
template <typename Item, typename Key>
std::vector<const Item*> Ordered(const std::vector<Item>& items, Key&& key) {
  std::vector<const Item*> ordered;
  for (const Item& item : items) ordered.push_back(&item);
  std::ranges::stable_sort(ordered, {}, [&key](const Item* item) { return key(*item); });
  if (ordered.size() > kMostRowsShown) ordered.resize(kMostRowsShown);
  return ordered;
}

std::string EffectText(const SoakFault& fault) {
  if (NeverStarted(fault)) return fault.observed_how.empty() ? "not started" : fault.observed_how;
  if (LacksEffect(fault)) return "NO";
  return (fault.observed ? "yes: " : "no: ") + fault.observed_how;
}

std::string EachFault(const SoakResult& result) {
  HtmlTable table({"at", "for", "kind", "target", "<effect seen", "noticed after", "promised",
                   "recovered after", "name"});
  for (const SoakFault& fault :
       std::span(result.faults).first(std::min(result.faults.size(), kMostRowsShown))) {
    const bool late =
        fault.noticed_after_s && fault.promised_s && *fault.noticed_after_s > *fault.promised_s;
    table.Row();
    table.Cell(fmt::format("{:.1f} s", StartOf(fault)));
    table.Cell(fault.for_s > 0 ? fmt::format("{:.1f} s", fault.for_s) : "-");
    table.Cell(fault.kind);
    table.Cell(fault.target);
    table.Cell(EffectText(fault), LacksEffect(fault) ? "text bad" : "text");
    table.Cell(FormatSeconds(fault.noticed_after_s), late ? "bad" : "");
    table.Cell(FormatSeconds(fault.promised_s));
    table.Cell(FormatSeconds(fault.recovered_after_s));
    table.Cell(NameOf(fault));
  }
  return table.Html(result.faults.size());
}

}  // namespace

std::string HtmlText(std::string_view text) { return HtmlEscaped(WellFormed(text)); }

std::string HistogramSection(const SoakResult& result) {
  if (result.histograms.empty()) return "";
  HtmlTable table({"figure", "values", "median", "99 %", "99.9 %", "max", "<budgets"});
  for (const SoakHistogram& measured : result.histograms) {
    const auto cell = [&](std::int64_t value) { table.Cell(FormatValue(measured.unit, value)); };
    const Histogram& histogram = measured.histogram;
    table.Row();
    table.Cell(measured.name);
    table.Count(histogram.Count());
    cell(histogram.Quantile(0.5));
    cell(histogram.Quantile(0.99));
    cell(histogram.Quantile(0.999));
    cell(histogram.Max());
    table.Cell(fmt::format("{}", fmt::join(FormatBudgets(measured), "; ")),
               WithinBudgets(measured) ? "text good" : "text bad");
  }
  return "<h2>Figures against budgets</h2>\n" + table.Html(result.histograms.size());
}

std::string ViolationSection(const SoakResult& result) {
  if (result.violations.empty()) return "<h2>Violations</h2>\n<p class=\"good\">None.</p>\n";
  HtmlTable table({"time", "vehicle", "what", "<words", "follows"});
  for (const SoakViolation& violation :
       std::span(result.violations).first(std::min(result.violations.size(), kMostRowsShown))) {
    table.Row();
    table.Cell(fmt::format("{:.2f} s", violation.time_s));
    table.Cell(FormatWho(violation.vehicle, violation.other));
    table.Cell(violation.invariant, "bad");
    table.Cell(violation.words, "text");
    table.Cell(violation.fault.empty() ? "-" : violation.fault);
  }
  return "<h2>Violations</h2>\n" +
         table.Html(std::max<std::size_t>(result.violations_counted, result.violations.size()));
}

std::string FaultSection(const SoakResult& result) {
  if (result.faults.empty() && result.skipped_faults.empty()) return "";
  HtmlTable table({"kind", "planned", "effect seen", "noticed", "median", "latest", "late",
                   "recovered", "median", "latest"});
  const std::vector<FaultSummary> summaries = SummariesOf(result.faults);
  for (const FaultSummary& summary : summaries) {
    table.Row();
    table.Cell(summary.kind);
    table.Count(summary.planned);
    table.Cell(fmt::format("{}", summary.observed), summary.missing == 0 ? "good" : "bad");
    table.Count(summary.noticed_s.size());
    table.Cell(FormatSeconds(MedianOf(summary.noticed_s)));
    table.Cell(FormatSeconds(GreatestOf(summary.noticed_s)));
    table.Cell(fmt::format("{}", summary.late), summary.late == 0 ? "" : "bad");
    table.Count(summary.recovered_s.size());
    table.Cell(FormatSeconds(MedianOf(summary.recovered_s)));
    table.Cell(FormatSeconds(GreatestOf(summary.recovered_s)));
  }
  std::string html = "<h2>Faults</h2>\n" + table.Html(summaries.size()) + "<h2>Each fault</h2>\n" +
                     EachFault(result);
  for (const std::string& skipped :
       std::span(result.skipped_faults)
           .first(std::min(result.skipped_faults.size(), kMostRowsShown))) {
    html += "<p>Skipped: " + HtmlText(skipped) + "</p>\n";
  }
  return html;
}

std::string SlopeSection(const SoakResult& result) {
  if (result.slopes.empty()) return "";
  HtmlTable table(
      {"process", "life", "resource", "at its end", "an hour", "95 % interval", "over", "leak"});
  for (const ResourceSlope* row : Ordered(result.slopes, [](const ResourceSlope& slope) {
         return std::pair(!slope.leak, slope.slope.chance);
       })) {
    table.Row();
    table.Cell(row->process);
    table.Count(row->life + 1);
    table.Cell(ToString(row->kind));
    table.Cell(FormatResource(row->kind, row->last));
    table.Cell(FormatResource(row->kind, row->slope.per_hour));
    table.Cell(fmt::format("{} to {}", FormatResource(row->kind, row->slope.low_per_hour),
                           FormatResource(row->kind, row->slope.high_per_hour)));
    table.Cell(FormatSpan(row->slope.spans_s));
    table.Cell(row->leak ? "LEAK" : "no", row->leak ? "bad" : "");
  }
  return "<h2>Growth of the processes</h2>\n" + table.Html(result.slopes.size());
}

std::string NearMissSection(const SoakResult& result) {
  if (result.near_misses.empty()) return "";
  HtmlTable table({"shell to shell", "vehicles", "time", "place"});
  for (const NearMiss* miss :
       Ordered(result.near_misses, [](const NearMiss& near) { return near.distance_m; })) {
    table.Row();
    table.Cell(fmt::format("{:.3f} m", miss->distance_m));
    table.Cell(FormatWho(miss->vehicle, miss->other));
    table.Cell(fmt::format("{:.1f} s", miss->time_s));
    table.Cell(fmt::format("{:.2f}, {:.2f} m", miss->x_m, miss->y_m));
  }
  return "<h2>Near misses</h2>\n" +
         table.Html(std::max<std::size_t>(result.near_misses_counted, result.near_misses.size()));
}

std::string AccountingSection(const SoakResult& result) {
  if (result.accounting.empty()) return "";
  HtmlTable table({"writer", "reader", "topic", "sent", "accepted", "not heard", "refused",
                   "superseded", "lost", "difference"});
  for (const AccountingRow* row :
       Ordered(result.accounting, [](const AccountingRow& one) { return one.Difference() == 0; })) {
    table.Row();
    table.Cell(row->writer);
    table.Cell(row->reader);
    table.Cell(row->topic);
    for (const std::uint64_t count :
         {row->sent, row->accepted, row->not_heard, row->refused, row->superseded, row->lost}) {
      table.Count(count);
    }
    table.Cell(fmt::format("{}", row->Difference()), row->Difference() == 0 ? "good" : "bad");
  }
  return "<h2>Accounting of samples</h2>\n" + table.Html(result.accounting.size());
}

}  // namespace giveway::fleetctl
