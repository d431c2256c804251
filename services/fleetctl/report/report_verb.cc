#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/playback/playback.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/report/report_compare.h"
#include "services/fleetctl/report/report_show.h"
#include "services/fleetctl/soak/soak_draw.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/fleetctl/soak/soak_page.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kReportFooter = R"(
A report is what fleetctl soak --report FOLDER wrote: the folder, or its report.json. One is printed as a
summary. Of two, what got worse from the first to the second, with the chance that equal soaks
differ so much. The unit of observation is a block of time, a twentieth of the run, not the single
value: one burst of loss delays hundreds. If blocks are independent, all tests together call equal
programs worse at most once in 200. A verdict that fell, beacons not accounted for, and a leak that only
the second names are worse without a test: a soak names a leak that is none once in 100 times.
  figures   histograms by block: mean, median, 99 % (signed ranks)
  counts    by block: violations, near misses, reactions that left less
            than a fifth (signed ranks)
  faults    by kind, one value a block: noticed and recovered after
            (Mann-Whitney), late, without effect (Fisher)
  slopes    Theil-Sen, by 95 % intervals; from 64 KiB, 1 descriptor,
            1 thread or 0.05 processors an hour on
  untested  what stems from one event, such as healing; figures and counts
            of soaks of different durations, of resumed ones, and of
            reports without blocks: shown, with the reason
Times must differ by 5 %. Both soaks must have one scenario, one fault file, as many vehicles.

Of an MCAP recording, as fleetctl record and fleetctl run --record-topics write it, the report is a page
that needs nothing else: figures of each vehicle, all paths on a map, who did what when, plots of the
fleet, and the run itself to look at. Without --page run.mcap gives run.html.

Examples
  fleetctl report run.mcap --scenario intersection_yield
  fleetctl report nightly --page nightly.html
  fleetctl report last-release nightly
  fleetctl report last-release nightly --json | jq -r '.figures[] | select(.change=="worse").what'

Exit code: of two, 0 nothing worse, 1 something worse, 2 they could not be compared. Of one, that of
its soak. Of a recording, 0 written, 1 there is nothing of a fleet in it, 2 it could not be read, or is
damaged: the page has what is before that. One that was cut off is whole as far as it goes.
)";

struct ReportOptions {
  std::vector<std::string> reports;
  bool all = false;
  bool json = false;
  std::string page_file;  // of a single report; empty: none, or run.html of run.mcap
  std::string scenario;   // of a recording: shows its walls
};

int ReportRecording(const ReportOptions& options) {
  const std::string& file = options.reports.front();
  if (options.json || options.all || options.reports.size() > 1) {
    std::fprintf(stderr,
                 "%s: of a recording there is a page alone; leave out --json, --all and "
                 "other reports\n",
                 file.c_str());
    return kCouldNotRun;
  }
  PlaybackOptions page{.file = file, .scenario = options.scenario, .report = true};
  page.html_file = options.page_file;
  if (page.html_file.empty()) page.html_file = file.substr(0, file.rfind('.')) + ".html";
  return RunPlayback(page);
}

// Reports on stderr what is wrong with any of them.
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

// The exit code: `code`, but at least 1 if the text could not be written.
int Concluded(const std::string& text, int code) {
  if (PrintAll(text)) return code;
  std::fprintf(stderr, "cannot write the report to stdout\n");
  return std::max(code, 1);
}

int RunReport(const ReportOptions& options) {
  if (std::ranges::any_of(options.reports, IsMcapFile)) return ReportRecording(options);
  std::vector<SoakResult> results;
  if (!ReadAllReports(options, &results)) return kCouldNotRun;
  if (results.size() == 1) {
    const SoakResult& only = results.front();
    if (!options.page_file.empty()) WriteSoakPage(only, options.page_file);
    return Concluded(options.json ? ToJson(only) + "\n" : ForTerminal(ToText(only)),
                     ExitCode(only.verdict));
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
  return Concluded(
      options.json ? ToJson(comparison) + "\n" : ForTerminal(ToText(comparison, options.all)),
      comparison.AnyWorse() ? 1 : 0);
}

}  // namespace

void AddReportVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* verb = fleetctl->add_subcommand(
      "report",
      "Show the report of a soak or of a recorded run, or say what got worse between two soaks");
  verb->footer(kReportFooter);
  verb->add_option("REPORT", options->reports, "One report or two: before, after; or an MCAP file")
      ->required()
      ->expected(1, 2);
  verb->add_flag("--all", options->all, "Show also what stayed the same");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->add_option("--page", options->page_file,
                   "Write the HTML page of the only report into this file");
  verb->add_option("--scenario", options->scenario,
                   "Of an MCAP file: shows the walls of this scenario");
  verb->callback([options, exit_code] { *exit_code = RunReport(*options); });
}

}  // namespace giveway::fleetctl
