#include "services/world_node/world_loop.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "services/health/heap_in_use.h"
#include "services/link/fastdds/packets_of_process.h"
#include "services/node/service_run.h"
#include "services/runtime/identity.h"
#include "services/runtime/state_file.h"
#include "services/types/time.h"
#include "services/world_node/event_line.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Nanoseconds kLockstepPatience = seconds(1);
constexpr Nanoseconds kStopPoll = milliseconds(20);
constexpr Nanoseconds kFlushTimeout = milliseconds(500);
constexpr Nanoseconds kFlushWhenStopped = milliseconds(300);  // all is to be over in a second
constexpr Nanoseconds kCheckpointPeriod = milliseconds(200);
constexpr Nanoseconds kReminder = seconds(5);
constexpr Nanoseconds kHeapEvery = seconds(1);  // as a supervisor samples it
// For the vehicles of a world that was restarted to find it: those that do not are silent then.
constexpr Nanoseconds kResumePatience = seconds(10);
// A vehicle that joins a running fleet stands until it hears all peers, but not for ever.
constexpr Nanoseconds kUnheardStand = seconds(3);

std::string Text(VehicleId vehicle) { return std::to_string(Number(vehicle)); }

WorldEpoch EpochOf(const WorldLoopOptions& options) {
  const std::optional<sim::FleetCheckpoint>& checkpoint = options.checkpoint;
  if (checkpoint && options.same_epoch) return checkpoint->run.epoch;
  WorldEpoch epoch{RandomNonZero()};
  while (checkpoint && epoch == checkpoint->run.epoch) epoch = WorldEpoch{RandomNonZero()};
  return epoch;
}

}  // namespace

WorldLoop::WorldLoop(const Scenario& scenario, link::WorldLink* link, ServiceAdmin* admin,
                     HealthService<WorldHealth>* health, const WorldLoopOptions& options)
    : scenario_(scenario),
      link_(*link),
      admin_(*admin),
      health_(*health),
      options_(options),
      epoch_(EpochOf(options)),
      fleet_(std::make_unique<Fleet>(scenario, epoch_, options)),
      start_by_(SteadyNow() + FromSeconds(scenario.start_timeout_s)),
      report_alone_(SteadyNow() + kReminder),
      interface_check_([link] { return link->InterfaceChange(); }) {
  const bool resumes = options_.checkpoint && Resume(*options_.checkpoint);
  if (!options_.checkpoint_file.empty()) StartCheckpoints(resumes);
}

// A disk that is full does not keep a run from its vehicles that could resume.
void WorldLoop::StartCheckpoints(bool resumes) {
  const std::string complaint = WriteStateFile(options_.checkpoint_file, State());
  if (!complaint.empty() && !resumes) throw std::runtime_error("--checkpoint " + complaint);
  NoteCheckpoint(complaint);
  checkpoint_writer_ = std::make_unique<StateWriter<>>(
      [this](const std::string& bytes) { return WriteStateFile(options_.checkpoint_file, bytes); });
}

bool WorldLoop::Resume(const sim::FleetCheckpoint& checkpoint) {
  if (!fleet_->admission.Restore(checkpoint)) {
    LogWarning("the checkpoint does not fit the scenario: starts a new run");
    fleet_ = std::make_unique<Fleet>(scenario_, epoch_, options_);
    return false;
  }
  if (!checkpoint.run.started) return true;
  resumed_with_.emplace();
  for (const VehicleId vehicle : fleet_->admission.Expected()) {
    if (!fleet_->run.IsAbandoned(vehicle)) resumed_with_->push_back(vehicle);
  }
  start_by_ = SteadyNow() + kResumePatience;
  LogInfo("resumes from the checkpoint with " + std::to_string(resumed_with_->size()) +
          " vehicles, " + std::to_string(fleet_->run.TimeSeconds()) + " s after the start");
  return true;
}

std::string WorldLoop::State() const {
  return sim::ToBytes(fleet_->admission.Save(options_.scenario_mark));
}

WorldEnd WorldLoop::Drive(const StopSignal& stop) {
  Ticker ticker(scenario_.tick_period);
  while (fleet_->run.State() != RunState::kEnded) {
    const std::uint32_t missed = ticker.Wait();
    if (fleet_->run.State() == RunState::kRunning) overruns_ += missed;
    if (options_.lockstep) AwaitAnswers(stop);
    if (stop.IsSet()) fleet_->run.End("interrupted");
    RunTick();
    if (interface_lost_ && !stop.IsSet()) return WorldEnd::kInterfaceLost;
    KeepCheckpoint();
    ReportHealth(HealthStage::kUnderWay);
    PublishHeapIfDue();
    ReportIfAlone();
    LogNews(link_.TakeRefusals(), link_.TakeUnfit(SteadyNow()), SteadyNow(), &refusal_log_);
    LogDrops(link::PacketsOfProcess(), SteadyNow(), &packet_log_);
    const bool goes = !resumed_with_ || fleet_->run.State() == RunState::kRunning;
    if (goes && options_.on_back) std::exchange(options_.on_back, nullptr)();
    const bool ordered = admin_.Serve();
    const bool settled = !options_.on_back;  // else what it came back for is not done
    if (!stop.IsSet() && (ordered || (settled && HasLostSharedMemory()))) {
      link_.FlushAnswer(kFlushTimeout);  // a vehicle that misses the next scan halts
      return WorldEnd::kRestarts;
    }
  }
  ReportHealth(HealthStage::kLeaving);
  const bool passed = AnnounceEnd(stop.IsSet() ? kFlushWhenStopped : kFlushTimeout);
  return passed ? WorldEnd::kPassed : WorldEnd::kFailed;
}

bool WorldLoop::HasLostSharedMemory() {
  if (options_.lockstep || !link_.SharedMemoryIsGone()) return false;
  LogError(kSharedMemoryDeleted);
  return true;
}

void WorldLoop::RunTick() {
  sim::Run& run = fleet_->run;
  Admit();
  TakeCommands();
  CountSpeaking();
  if (run.State() == RunState::kWaiting) StartIfReady();
  run.Advance(commands_);
  for (const VehicleId vehicle : run.Forgotten()) link_.ForgetVehicle(vehicle);
  commands_.clear();
  fleet_->admission.FollowRun();
  Close();
  Publish();
  ReportLeftOut();
}

void WorldLoop::Admit() {
  for (const JoinRequest& request : link_.TakeJoins()) fleet_->admission.Take(request);
  Close();
  for (const RosterEntry& entry : fleet_->admission.Answer()) {
    if (!entry.accepted) {
      const std::string what = entry.waiting ? "lets a vehicle wait: " : "refused a vehicle: ";
      if (answer_lines_.Take(SteadyNow())) LogWarning(what + entry.reason);
    } else if (const sim::Body* body = fleet_->run.BodyOf(entry.vehicle)) {
      link_.OpenVehicle(entry.vehicle, body->profile);
      next_checkpoint_ = {};
      if (entry.run_state == RunState::kRunning) Welcome(entry);
    }
    link_.SendRoster(entry);
  }
}

void WorldLoop::ReportLeftOut() {
  const SteadyTime now = SteadyNow();
  const auto answers = answer_lines_.TakeLeftOut(now);
  const auto events = event_lines_.TakeLeftOut(now);
  if (answers > 0) LogWarning("and " + std::to_string(answers) + " more such answers");
  if (events > 0) LogInfo("and " + std::to_string(events) + " more such events");
}

// A new vehicle under this id has not been heard yet, even if the last one was.
void WorldLoop::Welcome(const RosterEntry& entry) {
  Newcomer& newcomer = newcomers_[entry.vehicle];
  if (newcomer.session == entry.session) return;
  const auto stand = TicksCovering(kUnheardStand, scenario_.tick_period);
  newcomer = {entry.session, After(fleet_->run.Now(), stand)};
  heard_.erase(entry.vehicle);
}

// Forgets the vehicles whose bodies are gone.
void WorldLoop::Close() {
  for (const VehicleId vehicle : fleet_->admission.TakeGone()) {
    link_.CloseVehicle(vehicle);
    next_checkpoint_ = {};
    heard_.erase(vehicle);
    newcomers_.erase(vehicle);
    if (resumed_with_) std::erase(*resumed_with_, vehicle);  // else they wait for it
  }
}

void WorldLoop::TakeCommands() {
  const auto commands = link_.TakeCommands();
  const SteadyTime now = SteadyNow();
  interface_lost_ = interface_check_.MustEnd(now, !commands.empty());
  for (const MotorCommand& command : commands) Heed(command);
  for (const MotorCommand& command : commands_) {
    if (command.epoch == epoch_) reactions_.Applied(command, now);
  }
}

// Of an old world the run refuses and counts it.
void WorldLoop::Heed(const MotorCommand& command) {
  if (!MayCommand(command)) return;
  commands_.push_back(command);
  if (command.epoch == epoch_) {
    heard_[command.vehicle] = {command.tick, command.matched_peers, true};
    return;
  }
  const double epoch = Number(epoch_);
  LogRefused(command, {"world_epoch", double(Number(command.epoch)), epoch, epoch}, true);
}

// A vehicle without a place has no wheels here, and a command cannot answer a scan that is to come.
bool WorldLoop::MayCommand(const MotorCommand& command) {
  if (!fleet_->admission.Informed().contains(command.vehicle)) return command.epoch != epoch_;
  const Tick now = fleet_->run.Now();
  if (command.epoch != epoch_ || command.tick <= now) return true;
  LogRefused(command, {"tick", double(Number(command.tick)), 0, double(Number(now))}, false);
  return false;
}

// The log says why, if the refusals continue.
void WorldLoop::LogRefused(const MotorCommand& command, const FieldFault& fault, bool passing) {
  const Refusal refusal{.sample = "motor command",
                        .vehicle = command.vehicle,
                        .writer = Number(command.vehicle),
                        .counter = "not obeyed",
                        .field = fault.field,
                        .why = Describe(fault),
                        .passing = passing};
  LogNews({&refusal, 1}, {}, SteadyNow(), &refusal_log_);
}

// It is matched with the world, and with the beacons of every other vehicle that lives.
bool WorldLoop::IsReady(VehicleId vehicle) const {
  const auto reception = heard_.find(vehicle);
  const auto& informed = fleet_->admission.Informed();
  return reception != heard_.end() && informed.contains(vehicle) && link_.IsMatched(vehicle) &&
         reception->second.matched_peers + 1 >= speaking_;
}

void WorldLoop::CountSpeaking() {
  speaking_ = static_cast<std::size_t>(std::ranges::count_if(
      fleet_->admission.Informed(),
      [this](const auto& informed) { return !fleet_->run.IsAbandoned(informed.first); }));
}

// Which vehicles are still waited for; empty if none.
std::string WorldLoop::Missing() const {
  const auto& informed = fleet_->admission.Informed();
  if (sim::IsOpen(scenario_) && !resumed_with_) {
    const auto ready =
        std::ranges::count_if(informed, [this](const auto& entry) { return IsReady(entry.first); });
    const auto needed = std::max(1U, scenario_.start_with);
    if (ready >= static_cast<std::ptrdiff_t>(needed)) return {};
    return std::to_string(needed - static_cast<std::uint32_t>(ready)) + " of " +
           std::to_string(needed) + " vehicles";
  }
  std::string missing;
  const auto wait_for = [&](VehicleId vehicle) {
    if (!IsReady(vehicle)) missing += (missing.empty() ? "" : " ") + Text(vehicle);
  };
  if (resumed_with_) {
    std::ranges::for_each(*resumed_with_, wait_for);
  } else {
    std::ranges::for_each(scenario_.vehicles, wait_for, &VehicleOptions::id);
  }
  return missing;
}

void WorldLoop::StartIfReady() {
  const std::string missing = Missing();
  const bool patient = sim::IsOpen(scenario_) && !resumed_with_ && scenario_.start_with == 0;
  if (!missing.empty() && (patient || SteadyNow() <= start_by_)) return;
  if (!missing.empty() && !resumed_with_) {
    fleet_->run.End("start_timeout: not joined and matched in time: " + missing);
    return;
  }
  if (!missing.empty()) LogWarning("starts without: " + missing);
  fleet_->run.Start();
  next_checkpoint_ = {};
  for (const RosterEntry& entry : fleet_->admission.InformAll("")) link_.SendRoster(entry);
  LogInfo("started with " + std::to_string(fleet_->admission.Informed().size()) + " vehicles");
}

// A vehicle wakes on its ranges, so they go last of what it senses.
void WorldLoop::Publish() {
  const sim::Run& run = fleet_->run;
  if (run.State() == RunState::kRunning) reactions_.Published(run.Now(), SteadyNow());
  const auto& informed = fleet_->admission.Informed();
  const auto is_informed = [&](const auto& scan) { return informed.contains(scan.vehicle); };
  for (const SignalState& signal : run.Signals()) link_.SendSignal(signal);
  for (const RadarScan& scan : run.Radars()) {
    if (is_informed(scan)) link_.SendRadar(scan);
  }
  for (const LidarScan& scan : run.Lidars()) {
    if (is_informed(scan)) link_.SendLidar(scan);
  }
  for (const CameraScan& scan : run.Cameras()) {
    if (is_informed(scan)) link_.SendCamera(scan);
  }
  for (const PoseFix& fix : run.PoseFixes()) {
    if (is_informed(fix)) link_.SendPoseFix(fix);
  }
  for (RangeScan scan : run.Scans()) {
    if (!is_informed(scan)) continue;
    if (MustStand(scan.vehicle)) scan.run_state = RunState::kWaiting;
    link_.SendScan(scan);
  }
  for (const Truth& truth : run.Truths()) link_.SendTruth(truth);
  for (const WorldEvent& event : run.Events()) SendEvent(event);
}

bool WorldLoop::MustStand(VehicleId vehicle) const {
  const auto newcomer = newcomers_.find(vehicle);
  return newcomer != newcomers_.end() && fleet_->run.State() == RunState::kRunning &&
         TicksBetween(fleet_->run.Now(), newcomer->second.stands_until) > 0 && !IsReady(vehicle);
}

void WorldLoop::SendEvent(const WorldEvent& event) {
  link_.SendEvent(event);
  const std::string line = LogLine(event);
  if (!line.empty() && event_lines_.Take(SteadyNow())) LogInfo(line);
}

// Lockstep: the tick ends when all vehicles that still answer have answered it. Vehicles that are
// stopped together with the world answer no more, and a stop leaves it less than this patience.
void WorldLoop::AwaitAnswers(const StopSignal& stop) {
  const SteadyTime give_up = SteadyNow() + kLockstepPatience;
  while (Unanswered() && SteadyNow() < give_up && !stop.IsSet()) {
    if (!link_.WaitForCommands(std::min(kStopPoll, give_up - SteadyNow()))) continue;
    for (const MotorCommand& command : link_.TakeCommands()) Heed(command);
  }
  for (auto& [vehicle, reception] : heard_) {
    reception.waited_for = reception.answered == fleet_->run.Now();
  }
}

bool WorldLoop::Unanswered() const {
  for (const auto& [vehicle, reception] : heard_) {
    if (reception.waited_for && reception.answered != fleet_->run.Now()) return true;
  }
  return false;
}

// After the tick's scans are out: the vehicles compute meanwhile. At once where a vehicle joined or
// left.
void WorldLoop::KeepCheckpoint() {
  if (!checkpoint_writer_) return;
  NoteLastCheckpoint();
  const SteadyTime now = SteadyNow();
  if (now < next_checkpoint_) return;
  next_checkpoint_ = now + kCheckpointPeriod;
  checkpoint_writer_->Write(State());
}

void WorldLoop::NoteLastCheckpoint() {
  const auto outcome = checkpoint_writer_->TakeOutcome();
  if (outcome) NoteCheckpoint(*outcome);
}

// That it could not be written, and why; empty: it was.
void WorldLoop::NoteCheckpoint(const std::string& complaint) {
  const std::string line = checkpoint_fault_.Note(complaint, SteadyNow());
  if (!line.empty()) LogWarning("checkpoint " + line);
}

bool WorldLoop::AnnounceEnd(Nanoseconds patience) {
  RunFigures figures = fleet_->run.Figures();
  figures.tick_overruns = overruns_;
  const sim::ReactionFigures reactions = reactions_.Figures();
  figures.reactions = reactions.count;
  figures.reaction_p50_ms = reactions.p50_ms;
  figures.reaction_p99_ms = reactions.p99_ms;
  figures.reaction_max_ms = reactions.max_ms;
  link_.SendFigures(figures);
  const std::string& reason = fleet_->run.EndReason();
  for (const RosterEntry& entry : fleet_->admission.InformAll(reason)) link_.SendRoster(entry);
  link_.Flush(patience);
  if (checkpoint_writer_) {
    checkpoint_writer_->Finish();
    NoteLastCheckpoint();
    RemoveStateFile(options_.checkpoint_file);  // what has ended does not resume
    LogInfo("the longest checkpoint took " +
            std::to_string(Milliseconds(checkpoint_writer_->Longest())) + " ms");
  }
  LogInfo("ended: " + reason + "; " + (figures.passed ? "passed" : "failed: " + figures.reason) +
          "; late for " + std::to_string(overruns_) + " ticks");
  return figures.passed;
}

// Where discovery servers are to be used, and none answers.
void WorldLoop::ReportIfAlone() {
  if (SteadyNow() < report_alone_) return;
  report_alone_ = SteadyNow() + kReminder;
  const std::string why = link_.WhyNoPeerIsFound();
  if (!why.empty()) LogWarning(why);
}

// A vehicle says it in its status; the world has none.
void WorldLoop::PublishHeapIfDue() {
  const SteadyTime now = SteadyNow();
  if (now < next_heap_) return;
  next_heap_ = now + kHeapEvery;
  if (const auto bytes = HeapInUse()) PublishHeap(*bytes);
}

void WorldLoop::ReportHealth(HealthStage stage) {
  const link::WorldLinkCounters link = link_.Counters();
  WorldHealth& now = health_.Now();
  now.loop.stage = stage;
  now.waits_for = ShortText(link_.WhyNoPeerIsFound());
  now.run_state = fleet_->run.State();
  now.time_s = fleet_->run.TimeSeconds();
  now.late_ticks = overruns_;
  now.vehicles_joined = static_cast<std::uint32_t>(fleet_->admission.Informed().size());
  now.contacts = fleet_->run.Contacts();
  now.reactions = reactions_.Count();
  now.commands_taken = link.commands_taken;
  now.commands_wrong_name = link.commands_wrong_name;
  now.commands_unbound = link.commands_unbound;
  now.commands_not_finite = link.commands_not_finite;
  now.commands_strangers = link.commands_strangers;
  now.joins_refused = link.joins_refused;
  now.orders_refused = link.orders_refused;
  now.write_failures = link.write_failures;
  now.command_latency = link.command_latency;
  now.packets = link::PacketsOfProcess();
  health_.Publish();
}

}  // namespace giveway
