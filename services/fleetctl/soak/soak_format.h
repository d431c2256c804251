// The figures of a soak as text, for page, terminal and comparison.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

std::string FormatVerdict(const SoakResult& result);  // "FAILED: vehicle-3 leaks; 2 contacts"
std::string FormatSpan(double seconds);               // "1 h 30 min", "42 s"
std::string FormatSeconds(const std::optional<double>& seconds);  // "0.350 s", "-"
// A value of a histogram: "12.3 ms", "0.42 m".
std::string FormatValue(HistogramUnit unit, std::int64_t value);
// "99 % at most 40 ms: kept", by budget.
std::vector<std::string> FormatBudgets(const SoakHistogram& measured);
// A resource, or its growth: "12.5 MiB", "+64 KiB", "3", "0.120".
std::string FormatResource(ResourceKind kind, double value);

// One kind of fault, over all occurrences.
struct FaultSummary {
  std::string kind;
  std::size_t planned = 0;
  std::size_t observed = 0;
  std::size_t missing = 0;        // without an effect, though there was something to act on
  std::size_t late = 0;           // noticed later than promised
  std::vector<double> noticed_s;  // ascending, those that were
  std::vector<double> recovered_s;
};
// By kind, in alphabetical order.
std::vector<FaultSummary> SummariesOf(const std::vector<SoakFault>& faults);
// The median, or the value above it; nullopt if there is none. Ascending.
std::optional<double> MedianOf(const std::vector<double>& ascending);
std::optional<double> GreatestOf(const std::vector<double>& ascending);

struct AccountingSums {
  AccountingRow sums;  // without names
  std::size_t rows = 0;
  std::size_t rows_that_differ = 0;
};
AccountingSums SumsOf(const std::vector<AccountingRow>& rows);

// The values of the whole run, as label and text: the first table of the summary and of the page.
struct SummaryRow {
  std::string label;
  std::string text;
  std::string link = {};  // a file in the report's folder that `text` links to; empty: none
};
std::vector<SummaryRow> SummaryOf(const SoakResult& result);

}  // namespace giveway::fleetctl
