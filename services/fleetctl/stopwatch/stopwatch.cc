#include "services/fleetctl/stopwatch/stopwatch.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <thread>

#include "services/config/scenario_file.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/stopwatch/stopwatch_limits.h"
#include "services/fleetctl/stopwatch/stopwatch_plan.h"
#include "services/fleetctl/stopwatch/stopwatch_show.h"
#include "services/fleetctl/stopwatch/stopwatch_trials.h"
#include "services/link/fastdds/library_release.h"
#include "services/runtime/process.h"
#include "services/types/vehicle_options.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

// A fleet has this many trials of a fault; then a new one continues with it.
constexpr std::uint32_t kTrialsAFleet = 20;
constexpr int kAttempts = 3;  // at cuts that came before discovery was complete

int CodeOf(StopwatchVerdict verdict) {
  constexpr int kNotKept = 1;
  if (verdict == StopwatchVerdict::kNotRun) return kCouldNotRun;
  return verdict == StopwatchVerdict::kKept ? 0 : kNotKept;
}

// A folder that is removed with this object.
class ScratchFolder {
 public:
  ScratchFolder() : path_(fs::temp_directory_path() / "giveway_stopwatch_XXXXXX") {
    std::string name = path_.string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw OutputError("cannot make a folder in " + fs::temp_directory_path().string() +
                        "; name one that can be written in TMPDIR");
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const fs::path& Path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<StopwatchTask> TasksOf(const StopwatchOptions& options) {
  std::vector<StopwatchTask> tasks;
  // The longest first, so that no fleet is left with one at the end.
  std::vector<Fault> faults = options.faults;
  std::stable_partition(faults.begin(), faults.end(), IsCut);
  for (const Fault fault : faults) {
    const std::uint32_t most = IsCut(fault) ? TargetsOf(options.vehicles) : kTrialsAFleet;
    for (std::uint32_t done = 0; done < options.trials; done += most) {
      const std::uint64_t seed = (static_cast<std::uint64_t>(options.seed) << 32U) + tasks.size();
      tasks.push_back({fault, std::min(most, options.trials - done), seed,
                       StopwatchVehicles(options.vehicles)});
    }
  }
  return tasks;
}

// Distributes tasks to threads, each with a fleet of its own, and collects the results.
class Session {
 public:
  Session(const StopwatchOptions& options, FleetSpec spec, const Limits& limits)
      : options_(options),
        spec_(std::move(spec)),
        limits_(limits),
        tasks_(TasksOf(options)),
        wanted_(options.trials * options.faults.size()),
        begin_(SteadyNow()) {}

  StopwatchReport Run() {
    {
      std::vector<std::jthread> threads;
      const std::size_t fleets = std::min<std::size_t>(options_.fleets, tasks_.size());
      try {
        while (threads.size() < fleets) threads.emplace_back([this] { Work(); });
      } catch (const std::system_error&) {
        if (threads.empty()) throw;  // fewer of them measure the same, for longer
      }
    }
    // Previous measurements are shown all the same.
    if (error_ && trials_.empty()) std::rethrow_exception(error_);
    if (next_ < tasks_.size() && report_.problems.empty()) report_.problems = {"interrupted"};
    report_.interrupted = trials_.size() < wanted_ && Interrupts::Count() > 0;
    report_.vehicles = options_.vehicles;
    report_.fleets = options_.fleets;
    report_.seed = options_.seed;
    report_.qos_file = spec_.qos_file;
    report_.limits = limits_;
    report_.library_major = link::LibraryMajor();
    report_.cells = EvaluateTrials(trials_, limits_);
    report_.took_s = Seconds(SteadyNow() - begin_);
    return std::move(report_);
  }

 private:
  void Work() {
    try {
      while (const auto number = NextTask()) {
        FleetSpec spec = spec_;
        const StopwatchTask& task = tasks_[*number];
        std::string& logs = spec.options.logs_folder;
        if (!logs.empty()) {
          logs = fs::path(logs) / fmt::format("{}-{}", *number + 1, Name(task.fault));
          CheckFolder(logs);
        }
        StopwatchResult result;
        for (int i = 0; i < kAttempts && (i == 0 || result.too_soon); ++i) {
          result = Conduct(task, spec, limits_, monitor_,
                           [this](std::size_t trials) { ShowProgress(trials); });
        }
        Gather(task, result);
      }
    } catch (const std::exception& error) {
      const std::scoped_lock lock(mutex_);
      if (!error_) error_ = std::current_exception();
      report_.problems.emplace_back(error.what());
    }
  }

  std::optional<std::size_t> NextTask() {
    const std::scoped_lock lock(mutex_);
    if (next_ == tasks_.size() || error_ || Interrupts::Count() > 0) return std::nullopt;
    return next_++;
  }

  void Gather(const StopwatchTask& task, const StopwatchResult& result) {
    const std::scoped_lock lock(mutex_);
    trials_.insert(trials_.end(), result.trials.begin(), result.trials.end());
    report_.false_alarms += result.false_alarms;
    if (result.problem.empty()) return;
    report_.problems.push_back(fmt::format("{}: {}", Name(task.fault), result.problem));
  }

  // On stderr, with the remaining time at the pace so far.
  void ShowProgress(std::size_t trials) {
    const std::scoped_lock lock(mutex_);
    done_ += trials;
    if (done_ == 0) return;
    const double gone_s = Seconds(SteadyNow() - begin_);
    const double share = static_cast<double>(done_) / static_cast<double>(wanted_);
    std::fprintf(stderr, "%4.0f s: %zu of %zu trials, about %.0f s left\n", gone_s, done_, wanted_,
                 gone_s * (1 - share) / share);
  }

  const StopwatchOptions& options_;
  const FleetSpec spec_;
  const Limits limits_;
  const std::vector<StopwatchTask> tasks_;
  const std::size_t wanted_;
  const SteadyTime begin_;
  StallMonitor monitor_;
  std::mutex mutex_;  // guards all members below
  std::size_t next_ = 0;
  std::size_t done_ = 0;
  std::vector<Trial> trials_;
  StopwatchReport report_;
  std::exception_ptr error_;
};

}  // namespace

int RunStopwatch(const StopwatchOptions& options) {
  const ScratchFolder scratch;
  const std::string scenario_file = (scratch.Path() / "stopwatch.textproto").string();
  WriteFile(scenario_file, StopwatchScenario(StopwatchVehicles(options.vehicles)));
  const std::string qos_file = ResolveQosFile(options.qos_file);
  const Scenario scenario = LoadScenario(scenario_file, {});
  static_cast<void>(ReadSoundQos(qos_file, DeploymentOf(scenario)));
  const Limits limits =
      ReadLimits(qos_file, options.interface, options.vehicles + 1, scenario.vehicles.front());
  if (options.table) {
    return PrintAll(FoldedForTerminal(TableText(limits))) ? 0 : kCouldNotRun;
  }
  if (!options.logs_folder.empty()) CheckFolder(options.logs_folder);
  const Interrupts interrupts;
  FleetSpec spec{.program_folder = ProgramFolder(),
                 .scenario_file = scenario_file,
                 .qos_file = qos_file,
                 .flags_only = true};
  spec.options.interface = options.interface;
  spec.options.logs_folder = options.logs_folder;
  spec.options.vehicles = 0;  // without an id of the scenario
  Session session(options, spec, limits);
  const StopwatchReport report = session.Run();
  if (!PrintAll(options.json ? StopwatchJson(report) : ForTerminal(StopwatchText(report)))) {
    std::fprintf(stderr, "cannot write the figures to stdout\n");
    return kCouldNotRun;
  }
  return CodeOf(report.Verdict());
}

}  // namespace giveway::fleetctl
