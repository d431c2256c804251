#include "services/fleetctl/virtual/virtual.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>

#include "services/config/problem.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/virtual/virtual_batch.h"
#include "services/fleetctl/virtual/virtual_mcap.h"
#include "services/report/virtual_report.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr std::size_t kFailingSeedsShown = 100;

// By nearest rank; the values are sorted and not empty.
double Percentile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5);
  return sorted[rank];
}

// Those that make a run fail.
std::string BrokenNames(const std::vector<BrokenInvariant>& violations,
                        sim::InvariantSet required) {
  std::string names;
  for (std::size_t i = 0; i < violations.size(); ++i) {
    const BrokenInvariant& broken = violations[i];
    if (i < required.size() && !required.test(i)) continue;
    if (broken.count > 0) names += (names.empty() ? "" : ", ") + broken.name;
  }
  return names;
}

// Means over all vehicles.
TrafficReport MeansOf(const sim::TrafficFigures& sums, std::uint32_t vehicles) {
  TrafficReport means;
  if (vehicles == 0) return means;
  const auto each = [vehicles](std::uint64_t sum) { return static_cast<double>(sum) / vehicles; };
  for (std::size_t i = 0; i < sim::kRuleCount; ++i) {
    if (sums.by_rule_ns[i] == 0) continue;
    means.by_rule_s.emplace_back(Name(static_cast<Rule>(i)), each(sums.by_rule_ns[i]) / 1e9);
  }
  means.stops = each(sums.stops);
  means.taken_back = each(sums.taken_back);
  return means;
}

VirtualReport ReportOf(const BatchTotals& totals, double wall_s, sim::InvariantSet required) {
  VirtualReport report;
  report.runs = totals.runs;
  report.failed_runs = static_cast<std::uint32_t>(totals.failing_seeds.size());
  report.contacts = totals.contacts;
  for (std::size_t i = 0; i < sim::kInvariantCount; ++i) {
    const auto name = sim::Name(static_cast<sim::Invariant>(i));
    report.violations.push_back({std::string(name), totals.violations[i]});
  }
  report.violations.push_back({"expectation", totals.unmet});
  if (totals.unmet > 0) {
    report.unmet = fmt::format("seed {}: {}", totals.first_unmet_seed, totals.first_unmet);
  }
  report.first_violations = totals.first_violations;
  report.vehicles = totals.vehicles;
  report.arrived = totals.arrived;
  report.vehicle_hours = totals.vehicle_seconds / 3600;
  if (wall_s > 0) report.vehicle_hours_per_minute = totals.vehicle_seconds / 60 / wall_s;
  if (!totals.delays_s.empty()) {
    report.delay_p50_s = Percentile(totals.delays_s, 0.5);
    report.delay_p99_s = Percentile(totals.delays_s, 0.99);
    report.delay_mean_s = std::accumulate(totals.delays_s.begin(), totals.delays_s.end(), 0.0) /
                          static_cast<double>(totals.delays_s.size());
  }
  report.min_separation_m = totals.separation_m;
  report.traffic = MeansOf(totals.traffic, totals.vehicles);
  report.trust = totals.trust;
  report.hash = fmt::format("{:016x}", totals.hash);
  const std::size_t shown = std::min(totals.failing_seeds.size(), kFailingSeedsShown);
  report.failing_seeds.assign(totals.failing_seeds.begin(),
                              totals.failing_seeds.begin() + static_cast<std::ptrdiff_t>(shown));
  const bool failed = !totals.failing_seeds.empty();
  report.verdict = failed ? Verdict::kFailed : Verdict::kPassed;
  report.reason = failed ? BrokenNames(report.violations, required) : "all_held";
  return report;
}

// A progress bar on stderr if that is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::uint64_t runs) : runs_(runs), shown_(::isatty(STDERR_FILENO) == 1) {}
  ~ProgressBar() {
    if (shown_) std::fputs("\r\x1b[2K", stderr);
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Show(const BatchTotals& so_far) const {
    if (!shown_) return;
    const double gone_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const std::string line =
        fmt::format("{}/{} runs, {} failing, {:.1f} vehicle-hours, {}", so_far.runs, runs_,
                    so_far.failing_seeds.size(), so_far.vehicle_seconds / 3600,
                    TimeLeft(so_far.runs, runs_, gone_s));
    fmt::print(stderr, "\r{}\x1b[K", ProgressLine(so_far.runs, runs_, line, StderrColumns()));
    std::fflush(stderr);
  }

 private:
  std::uint64_t runs_;
  bool shown_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Of the picture, which shows one seed: its whole verdict.
Headline HeadlineOf(const VirtualReport& report) {
  if (report.verdict == Verdict::kPassed) return {report.verdict, report.reason};
  const std::string unmet = report.unmet.empty() ? "" : "; " + report.unmet;
  return {report.verdict, "broken: " + report.reason + unmet};
}

int Print(const VirtualOptions& options, const VirtualReport& report) {
  const std::string text = options.json ? ToJson(report) + "\n" : ForTerminal(ToText(report));
  const int code = ExitCode(report.verdict);
  if (PrintAll(text)) return code;
  std::fprintf(stderr, "cannot write the verdict to stdout\n");
  return std::max(code, 1);
}

int RunAll(const VirtualOptions& options) {
  for (const std::string& file : {options.shown.picture, options.shown.trace}) {
    if (!file.empty()) CheckWritable(file);
  }
  if (!options.shown.mcap.empty()) CheckRecordable(options.shown.mcap);
  const CaseMaker maker(options.made_by);
  std::fputs(maker.Remark().c_str(), stderr);
  const Interrupts interrupts(Silence::kComputes);
  const SteadyTime start = SteadyNow();
  BatchTotals totals;
  {
    const ProgressBar bar(options.seeds.high - options.seeds.low + 1ULL);
    totals = RunBatch(maker, options.seeds, options.jobs, [&](const BatchTotals& so_far) {
      bar.Show(so_far);
      return Interrupts::Count() == 0;
    });
  }
  VirtualReport report =
      ReportOf(totals, Seconds(SteadyNow() - start),
               sim::RequiredInvariants() | sim::InvariantSet(options.made_by.also_required));
  report.scenario = maker.Name();
  report.jobs = options.jobs;
  if (Interrupts::Count() > 0) {
    report.verdict = Verdict::kFailed;
    report.reason = "interrupted";
  }
  const int code = Print(options, report);
  if (!options.shown.Any() || Interrupts::Count() > 0) return code;
  return WriteAfterVerdict(
      code, [&] { ShowRun(maker.Make(options.seeds.low), options.shown, HeadlineOf(report)); });
}

int RefuseToRun(const VirtualOptions& options, const char* reason, const std::exception& why) {
  std::fprintf(stderr, "%s\n", why.what());
  if (options.json) {
    VirtualReport report;
    report.scenario = options.made_by.scenario;
    report.reason = reason;
    Print(options, report);
  }
  return kCouldNotRun;
}

}  // namespace

int RunVirtual(const VirtualOptions& options) {
  try {
    return RunAll(options);
  } catch (const InputError& error) {
    return RefuseToRun(options, "bad_input", error);
  } catch (const OutputError& error) {
    return RefuseToRun(options, "unwritable_output", error);
  } catch (const std::exception& error) {  // out of memory, no thread
    return RefuseToRun(options, "could_not_start", error);
  }
}

}  // namespace giveway::fleetctl
