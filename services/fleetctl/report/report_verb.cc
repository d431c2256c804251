#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/report/report_compare.h"
#include "services/fleetctl/report/report_show.h"
#include "services/fleetctl/soak/soak_draw.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/fleetctl/soak/soak_page.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kFooter = R"(
A report is what fleetctl soak --report FOLDER wrote: the folder, or its report.json. One is printed as a
summary. Of two, what got worse from the first to the second, with the chance that equal soaks
differ so much; all tests together call equal soaks worse at most once in 200. A leak that
only the second names is worse without a test: a soak names one that is none once in 100 times.
  figures  histograms: Mann-Whitney for the median, Fisher for the share above the 99 % of both; no
           more than one value a vehicle and second counts as evidence
  slopes   Theil-Sen, by their 95 % intervals; from 64 KiB, 1 descriptor, 1 thread, 0.05 processors
           an hour on
  faults   by kind: how long until noticed and recovered (Mann-Whitney), how many late (Fisher)
  counts   violations, near misses, unplanned restarts by vehicle-hour (exact binomial)
Times must differ by 5 %. Both soaks must have one scenario, one fault file, as many vehicles.

Examples
  fleetctl report nightly --page nightly.html
  fleetctl report last-release nightly
  fleetctl report last-release nightly --json | jq -r '.figures[] | select(.change=="worse").what'

Exit code: of two, 0 nothing worse, 1 something worse, 2 they could not be compared. Of one, that of
its soak.
)";

struct ReportOptions {
  std::vector<std::string> reports;
  bool all = false;
  bool json = false;
  std::string page_file;  // of a single report; empty: none
};

// Says on stderr what is wrong with any of them.
bool ReadAllReports(const ReportOptions& options, std::vector<SoakResult>* results) {
  bool complete = true;
  for (const std::string& path : options.reports) {
    ReadSoak read = ReadSoakReport(path);
    if (!read.complaint.empty()) {
      std::fprintf(stderr, "%s\n", read.complaint.c_str());
      complete = false;
    }
    results->push_back(std::move(read.result));
  }
  return complete;
}

int RunReport(const ReportOptions& options) {
  std::vector<SoakResult> results;
  if (!ReadAllReports(options, &results)) return kCouldNotRun;
  if (results.size() == 1) {
    const SoakResult& only = results.front();
    if (!options.page_file.empty()) WriteSoakPage(only, options.page_file);
    std::fputs((options.json ? ToJson(only) + "\n" : ForTerminal(ToText(only))).c_str(), stdout);
    return ExitCode(only.verdict);
  }
  if (!options.page_file.empty()) {
    std::fprintf(stderr, "--page shows one report, and two were named; name one\n");
    return kCouldNotRun;
  }
  const std::string why_not = WhyNotComparable(results[0], results[1]);
  if (!why_not.empty()) {
    std::fprintf(stderr,
                 "cannot be compared: %s; name two soaks of one scenario under one fault "
                 "file\n",
                 why_not.c_str());
    return kCouldNotRun;
  }
  const SoakComparison comparison = Compare(results[0], results[1]);
  std::fputs((options.json ? ToJson(comparison) + "\n" : ToText(comparison, options.all)).c_str(),
             stdout);
  return comparison.AnyWorse() ? 1 : 0;
}

}  // namespace

void AddReportVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* verb = fleetctl->add_subcommand(
      "report", "Show the report of a soak, or say what got worse between two");
  verb->footer(kFooter);
  verb->add_option("REPORT", options->reports, "One report or two: before, after")
      ->required()
      ->expected(1, 2);
  verb->add_flag("--all", options->all, "Show also what stayed the same");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->add_option("--page", options->page_file, "Write the HTML page of the only report again");
  verb->callback([options, exit_code] { *exit_code = RunReport(*options); });
}

}  // namespace giveway::fleetctl
