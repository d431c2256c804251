#include "services/fleetctl/run/run_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <utility>

#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/run/run_ends.h"
#include "services/observer/fleet/scene_json.h"
#include "services/observer/page/page_text.h"
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
    10;  // lockstep waits for slow brains: it makes no promise about real time

constexpr std::size_t kMostErrorsShown = 20;

constexpr const char* kInterrupted = "interrupted";
constexpr int kCouldNotStart = 2;
constexpr int kCouldNotExec = 127;

Nanoseconds TimeLimit(const Scenario& scenario, bool lockstep) {
  if (IsEndless(scenario)) return kNoLimit;
  const double run_s = scenario.duration_s * (lockstep ? kLockstepSlowdown : 1);
  return FromSeconds(scenario.start_timeout_s + run_s + kSpareSeconds);
}

link::LinkOptions ObserverOptions(const FleetSpec& spec, const Scenario& scenario) {
  return {
      .domain = spec.domain,
      .interface = spec.options.interface,
      .qos = ReadSoundQos(spec.qos_file),
      .area = scenario.area,
      .fleet_size = static_cast<std::uint32_t>(scenario.vehicles.size() + scenario.spawns.size()),
      .impairment = {},
      .discovery_servers = spec.options.discovery_servers};
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

RunSession::RunSession(const RunOptions& options, const Scenario& scenario, const FleetSpec& spec)
    : scenario_(scenario),
      open_(!scenario.spawns.empty()),
      restarts_(options.restart),
      domain_(spec.domain),
      time_limit_(TimeLimit(scenario, spec.options.lockstep)),
      watch_(scenario, !options.picture_file.empty()),
      invariants_(scenario),
      has_page_(!options.html_file.empty()),
      observer_(ObserverOptions(spec, scenario),
                has_page_ ? link::ObserverLink::Ranges::kYes : link::ObserverLink::Ranges::kNo),
      topics_(options.topics_file.empty()
                  ? std::optional<TopicRecorder>()
                  : std::optional<TopicRecorder>(std::in_place, ObserverOptions(spec, scenario),
                                                 options.topics_file)),
      processes_(MakeCommands(spec, scenario)),
      comebacks_(&processes_),
      screen_(!options.json && IsTerminal()) {}

bool RunSession::FinishTopics(const std::vector<std::string>& attachments) {
  return !topics_ || topics_->Finish(attachments);
}

Report RunSession::Run() {
  std::optional<Overruled> overruled = Supervise();
  stopping_ = true;
  // The world first, so that it announces the end and the vehicles leave gracefully.
  if (overruled) processes_.AskToStop(kTheWorld);
  const bool announces = processes_.IsRunning(kTheWorld);
  const Nanoseconds grace = !overruled ? kLeaveGrace : announces ? kAnnounceGrace : Nanoseconds{0};
  const auto turn = [this] { Turn(); };
  if (!processes_.WaitUntilEnded(grace, turn)) processes_.EndAll(kTermGrace, turn);
  DrainLast();
  if (!overruled) {
    overruled = JudgeExits();
  } else if (const auto bad = FirstBadEnd(); bad && overruled->reason == kInterrupted) {
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
    if (restarts_) BringBack();
    if (const auto gone = FirstEarlyEnd()) return JudgeEnd(*gone);
    if (SteadyNow() > limit) return Overruled{Verdict::kFailed, "overran"};
  }
}

void RunSession::BringBack() {
  const SteadyTime now = SteadyNow();
  const auto stays_down = [this](const MemberEnd& end) {
    const auto known = brought_back_.find(end.member);
    return comebacks_.Awaits(end.member) ||
           !IsToComeBack(end, known == brought_back_.end() ? 0 : known->second);
  };
  while (const auto gone = processes_.FirstEndNotAllowed(stays_down)) {
    ShowTrouble(*gone, "died and is started again");
    ++brought_back_[gone->member];
    comebacks_.NoteEnd(gone->member, now);
  }
  const auto command = [this](MemberId member) { return processes_.CommandOf(member); };
  for (const FailedStart& failed : comebacks_.Turn(now, command)) {
    screen_.Finish();
    std::fprintf(stderr, "%s cannot be started again now: %s; it is tried again later\n",
                 NameOf(failed.member).c_str(), failed.why.c_str());
  }
}

std::optional<MemberEnd> RunSession::FirstEarlyEnd() const {
  const auto is_vehicle = [](MemberId member) { return member != kTheWorld; };
  const bool any_vehicle = processes_.AnyRunning(is_vehicle) || comebacks_.AwaitsAny(is_vehicle);
  return processes_.FirstEndNotAllowed([&](const MemberEnd& end) {
    return comebacks_.Awaits(end.member) || MayEndEarly(end, open_, any_vehicle);
  });
}

std::optional<MemberEnd> RunSession::FirstBadEnd() const {
  return processes_.FirstEndNotAllowed(
      [this](const MemberEnd& end) { return IsGoodEnd(end, open_); });
}

std::optional<Overruled> RunSession::JudgeEnd(const MemberEnd& gone) {
  const ProcessEnd end = gone.how;
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
  if (const auto bad = FirstBadEnd()) {
    ShowTrouble(*bad, "ended badly after the run");
    return Overruled{Verdict::kFailed, "process_died"};
  }
  const MemberEnd world = *processes_.EndOf(kTheWorld);
  if (world.how.number == kCouldNotStart) {
    ShowTrouble(world, "could not run");
    return Overruled{Verdict::kNotRun, "could_not_start"};
  }
  if (!watch_.HasFigures()) return Overruled{Verdict::kFailed, "no_figures"};
  return std::nullopt;
}

void RunSession::Drain() {
  const link::Observed observed = observer_.Take();
  watch_.Fold(observed);
  invariants_.Fold(observed);
  if (topics_) topics_->Turn(SteadyNow());
  if (!has_page_) return;
  view_.Fold(observed, SteadyNow());
  frames_.Note(view_, SteadyNow());
}

std::string RunSession::DrawPage() const {
  return PageWithRun(frames_.RunJson(SceneJson({"run", scenario_})));
}

void RunSession::Turn() {
  SleepUntil(SteadyNow() + kTurn);
  Drain();
  for (const VehicleId vehicle : watch_.TakeDueKills()) processes_.Kill(MemberOf(vehicle));
  processes_.Poll();
  ShowErrors();
  for (const std::string& complaint : processes_.TakeLogComplaints()) {
    screen_.Finish();
    std::fprintf(stderr, "%s\n", complaint.c_str());
  }
  for (const MemberEnd& gone : processes_.TakeEnds()) {
    const bool is_news = open_ && gone.member != kTheWorld;
    if (is_news && !stopping_ && !watch_.HasEnded()) ShowTrouble(gone, "ended");
  }
  TableView view = MakeView(scenario_, domain_, watch_);
  if (stopping_) view.state = "stopping";
  screen_.Show(view, SteadyNow());
}

// Of those that ended badly ShowTrouble shows the last lines.
void RunSession::ShowErrors() {
  for (const auto& [member, line] : processes_.TakeLines()) {
    const std::optional<MemberEnd>& end = processes_.EndOf(member);
    const bool is_well = !end || end->how == ProcessEnd{false, 0};
    if (!is_well || !IsErrorLine(line)) continue;
    if (errors_shown_ == kMostErrorsShown) return;
    screen_.Finish();
    std::fprintf(stderr, "%s\n", line.c_str());
    if (++errors_shown_ < kMostErrorsShown) continue;
    std::fputs("further errors are not shown; --logs FOLDER keeps them\n", stderr);
  }
}

void RunSession::ShowTrouble(const MemberEnd& gone, const std::string& what) {
  screen_.Finish();
  const std::deque<std::string>& said = processes_.LastLines(gone.member);
  std::string text = fmt::format("{} {}: {}", NameOf(gone.member), what, Describe(gone.how));
  text += said.empty() ? "; it said nothing\n" : "; the last it said:\n";
  for (const std::string& line : said) text += "  " + line + "\n";
  std::fputs(text.c_str(), stderr);
}

}  // namespace giveway::fleetctl
