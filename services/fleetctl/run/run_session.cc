#include "services/fleetctl/run/run_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Nanoseconds kTurn = milliseconds(20);
constexpr Nanoseconds kNewsUnderway = milliseconds(500);   // between an exit and its explanation
constexpr Nanoseconds kLeaveGrace = seconds(2);            // after the world announced the end
constexpr Nanoseconds kAnnounceGrace = milliseconds(300);  // for the world to announce a stop
constexpr Nanoseconds kTermGrace = seconds(1);             // from SIGTERM to SIGKILL
constexpr Nanoseconds kLastWords = milliseconds(500);
constexpr double kSpareSeconds = 10;
constexpr Nanoseconds kNoLimit = std::chrono::hours(24 * 365 * 100);
constexpr double kLockstepSlowdown =
    10;  // lockstep waits for slow brains: no real time is promised

constexpr std::size_t kMostErrorsShown = 20;

constexpr const char* kInterrupted = "interrupted";
constexpr int kCouldNotStart = 2;
constexpr int kCouldNotExec = 127;

Nanoseconds TimeLimit(const Scenario& scenario, bool lockstep) {
  if (IsEndless(scenario)) return kNoLimit;
  const double run_s = scenario.duration_s * (lockstep ? kLockstepSlowdown : 1);
  return FromSeconds(scenario.start_timeout_s + run_s + kSpareSeconds);
}

link::LinkOptions ObserverOptions(const RunOptions& options, const Scenario& scenario,
                                  const FleetCommand& command) {
  return {command.domain,
          options.interface,
          command.qos_file,
          scenario.area,
          static_cast<std::uint32_t>(scenario.vehicles.size() + scenario.spawns.size()),
          false,
          {},
          options.discovery_servers};
}

std::vector<ChildCommand> WithLines(std::vector<ChildCommand> commands) {
  for (ChildCommand& command : commands) command.hands_on_lines = true;
  return commands;
}

TableView MakeView(const Scenario& scenario, std::uint32_t domain, const FleetWatch& watch) {
  TableView view;
  view.scenario = scenario.name;
  view.domain = domain;
  view.state = watch.HasStarted() ? "running" : "waiting";
  view.time_s = watch.TimeSeconds();
  view.duration_s = scenario.duration_s;
  view.vehicles.assign(watch.Vehicles().begin(), watch.Vehicles().end());
  view.statuses = watch.Statuses();
  view.silent = watch.Silent();
  return view;
}

}  // namespace

RunSession::RunSession(const RunOptions& options, const Scenario& scenario,
                       const FleetCommand& command)
    : scenario_(scenario),
      domain_(command.domain),
      time_limit_(TimeLimit(scenario, options.lockstep)),
      watch_(scenario, !options.picture_file.empty()),
      invariants_(scenario),
      observer_(ObserverOptions(options, scenario, command)),
      processes_(WithLines(MakeCommands(options, command, scenario)), scenario),
      screen_(!options.json && IsTerminal()) {}

Report RunSession::Run() {
  std::optional<Overruled> overruled = Supervise();
  stopping_ = true;
  // The world first, so that it announces the end and the vehicles leave in good order.
  if (overruled) processes_.World().AskToStop();
  const bool announces = processes_.World().IsRunning();
  StopAll(!overruled ? kLeaveGrace : announces ? kAnnounceGrace : Nanoseconds{0});
  DrainLast();
  if (!overruled) {
    overruled = JudgeExits();
  } else if (const ChildProcess* bad = processes_.FirstBadEnd();
             bad != nullptr && overruled->reason == kInterrupted) {
    ShowTrouble(*bad, "did not leave in good order");
  }
  screen_.Finish();
  invariants_.Finish(!overruled && watch_.HasEnded());
  Report report = watch_.MakeReport(overruled);
  invariants_.AddTo(&report);
  report.domain = domain_;
  return report;
}

std::optional<Overruled> RunSession::Supervise() {
  const SteadyTime limit = SteadyNow() + time_limit_;
  for (;;) {
    Turn();
    if (Interrupts::Count() > 0) return Overruled{Verdict::kFailed, kInterrupted};
    if (watch_.HasEnded()) return std::nullopt;
    if (const ChildProcess* gone = processes_.FirstUnplannedEnd()) return JudgeEnd(*gone);
    if (SteadyNow() > limit) return Overruled{Verdict::kFailed, "overran"};
  }
}

std::optional<Overruled> RunSession::JudgeEnd(const ChildProcess& gone) {
  const ProcessEnd end = *gone.End();
  const SteadyTime limit = SteadyNow() + kNewsUnderway;
  while (!end.by_signal && SteadyNow() < limit) {
    Turn();
    if (watch_.HasEnded()) return std::nullopt;
  }
  if (!end.by_signal && (end.number == kCouldNotStart || end.number == kCouldNotExec) &&
      !watch_.HasStarted()) {
    ShowTrouble(gone, "could not start");
    return Overruled{Verdict::kNotRun, "could_not_start"};
  }
  ShowTrouble(gone, "died");
  return Overruled{Verdict::kFailed, "process_died"};
}

void RunSession::StopAll(Nanoseconds grace) {
  if (WaitUntilAllEnded(grace)) return;
  processes_.AskAllToStop();
  if (WaitUntilAllEnded(kTermGrace)) return;
  processes_.SignalAll(SIGKILL);
  while (processes_.AnyRunning()) Turn();
}

bool RunSession::WaitUntilAllEnded(Nanoseconds grace) {
  const SteadyTime limit = SteadyNow() + grace;
  while (processes_.AnyRunning() && SteadyNow() < limit && Interrupts::Count() < 2) Turn();
  return !processes_.AnyRunning();
}

void RunSession::DrainLast() {
  const SteadyTime limit = SteadyNow() + kLastWords;
  do {
    Drain();
    if (watch_.HasFigures() && watch_.HasAllFinalStatuses()) return;
    Turn();
  } while (SteadyNow() < limit && Interrupts::Count() == 0);
}

std::optional<Overruled> RunSession::JudgeExits() {
  if (Interrupts::Count() > 0) return Overruled{Verdict::kFailed, kInterrupted};
  if (const ChildProcess* bad = processes_.FirstBadEnd()) {
    ShowTrouble(*bad, "ended badly after the run");
    return Overruled{Verdict::kFailed, "process_died"};
  }
  const ProcessEnd world = *processes_.World().End();
  if (world.number == kCouldNotStart) {
    ShowTrouble(processes_.World(), "could not run");
    return Overruled{Verdict::kNotRun, "could_not_start"};
  }
  if (!watch_.HasFigures()) return Overruled{Verdict::kFailed, "no_figures"};
  return std::nullopt;
}

void RunSession::Drain() {
  const link::Observed observed = observer_.Take();
  watch_.Fold(observed);
  invariants_.Fold(observed);
}

void RunSession::Turn() {
  SleepUntil(SteadyNow() + kTurn);
  Drain();
  for (const VehicleId vehicle : watch_.TakeDueKills()) processes_.Kill(vehicle);
  processes_.Poll();
  ShowErrors();
  for (const ChildProcess* child : processes_.TakeNewlyEnded()) {
    if (!stopping_ && !watch_.HasEnded()) ShowTrouble(*child, "ended");
  }
  TableView view = MakeView(scenario_, domain_, watch_);
  if (stopping_) view.state = "stopping";
  screen_.Show(view, SteadyNow());
}

void RunSession::ShowErrors() {
  for (const std::string& line : processes_.TakeErrors()) {
    if (errors_shown_ == kMostErrorsShown) return;
    screen_.Finish();
    std::fprintf(stderr, "%s\n", line.c_str());
    if (++errors_shown_ < kMostErrorsShown) continue;
    std::fputs("further errors are not shown; --logs FOLDER keeps them\n", stderr);
  }
}

void RunSession::ShowTrouble(const ChildProcess& child, const std::string& what) {
  screen_.Finish();
  std::string text = fmt::format("{} {}: {}", child.Name(), what, Describe(*child.End()));
  text += child.LastLines().empty() ? "; it said nothing\n" : "; the last it said:\n";
  for (const std::string& line : child.LastLines()) text += "  " + line + "\n";
  std::fputs(text.c_str(), stderr);
}

}  // namespace giveway::fleetctl
