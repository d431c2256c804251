#include "services/fleetctl/soak/soak_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/process/process_resources.h"
#include "services/fleetctl/process/run_key.h"
#include "services/fleetctl/run/run_ends.h"
#include "services/runtime/identity.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using faults::Kind;
using faults::Target;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Nanoseconds kTurn = milliseconds(50);
constexpr Nanoseconds kUntilAllDrive = seconds(60);
constexpr Nanoseconds kSampleEvery = seconds(1);
constexpr Nanoseconds kProgressEvery = seconds(10);
constexpr double kWorldBack_s = 10;  // at most, from the end of a fault that stopped the world
constexpr Nanoseconds kLeaveGrace = seconds(2);
constexpr Nanoseconds kTermGrace = seconds(3);
constexpr std::uint64_t kSharedMemoryEvery = 10;  // samples: it requires reading every map
constexpr std::size_t kMostEnds = 256;            // kept with their last lines
constexpr unsigned kConcluding_s = 60;            // the report of a large fleet, and a slow disk

// A soak that breaks shared memory keeps to UDP itself: a full /dev/shm would end it.
link::LinkOptions ObserverOf(const FleetSpec& spec, const Scenario& scenario,
                             bool breaks_shared_memory) {
  return {
      .domain = spec.domain,
      .interface = spec.options.interface,
      .qos = ReadSoundQos(spec.qos_file),
      .area = scenario.area,
      .fleet_size = static_cast<std::uint32_t>(scenario.vehicles.size() + scenario.spawns.size()),
      .discovery_servers = spec.options.discovery_servers,
      .requests_status_once = true,
      .lets_packets_gather = true,
      .leaves_out_shared_memory = breaks_shared_memory};
}

// Black boxes show them.
link::ObserverLink::Ranges RangesFor(const FleetSpec& spec) {
  return spec.options.record_ring.empty() ? link::ObserverLink::Ranges::kNo
                                          : link::ObserverLink::Ranges::kYes;
}

// "vehicle-3", "world": as in the report. Discovery servers are not measured.
std::string ProcessName(MemberId member) {
  if (member == kTheWorld) return "world";
  return member.kind == MemberKind::kVehicle ? fmt::format("vehicle-{}", member.number)
                                             : NameOf(member);
}

bool IsOfWorld(const faults::Fault& fault) {
  return faults::ActorOf(fault.kind) == faults::Actor::kWorld;
}

}  // namespace

SoakSession::SoakSession(const FleetSpec& spec, const Scenario& scenario,
                         const faults::Schedule& schedule, const SoakPhases& phases,
                         const Limits& limits, FaultTools tools)
    : schedule_(schedule),
      phases_(phases),
      limits_(limits),
      fleet_(SoakFleet(scenario, NewcomerCount(spec.options, scenario))),
      watch_(fleet_, schedule),
      invariants_(scenario),
      own_link_(ObserverOf(spec, scenario, tools.shm != nullptr)),
      observer_(own_link_, RangesFor(spec)),
      processes_(tools.commands),
      attackers_({tools.attacker, tools.domain, tools.interface}),
      faults_(std::move(tools), &processes_),
      restarts_(&processes_),
      clock_(schedule, std::not_fn(IsOfWorld)),
      world_clock_(schedule, IsOfWorld),
      resources_(phases.faults_from_s),
      course_(
          fleet_, [this](VehicleId vehicle) { return faults_.IsAway(MemberOf(vehicle)); },
          [this](VehicleId vehicle) { return faults_.IsAwayForGood(MemberOf(vehicle)); }),
      near_(RadiiOf(scenario, fleet_)),
      near_by_block_(BlockSeconds(phases.end_s)),
      timing_(MostBeaconAge(scenario), BlockSeconds(phases.end_s)),
      tick_period_s_(Seconds(scenario.tick_period)),
      turned_(SteadyNow()) {
  const std::string& ring_s = spec.options.record_ring;
  if (ring_s.empty()) return;
  const seconds ring(std::stoul(ring_s));
  rings_.emplace(own_link_, KeyToOrderWith(spec.options.admin_key, spec.domain), fleet_,
                 spec.options.record_folder, ring);
  black_box_.emplace(scenario, spec.options.record_folder, ring);
}

SoakSeen SoakSession::Run(const Saved& save) {
  save_ = save;
  seen_.started = WaitUntilAllDrive();
  if (seen_.started) {
    std::fprintf(stderr, "%zu vehicles drive; faults from %.0f to %.0f s, verdict at %.0f s\n",
                 fleet_.size(), phases_.faults_from_s, phases_.faults_until_s, phases_.end_s);
    while (Interrupts::Count() == 0 && !IsOver(SteadyNow())) {
      Turn();
      CarryOut(clock_.TakeDue(watch_.TimeSeconds(SteadyNow())));
      CarryOut(world_clock_.TakeDue(world_time_.Now_s()));
    }
  }
  seen_.interrupted = Interrupts::Count() > 0;
  if (seen_.started && !seen_.interrupted) NoteWhatDidNotEnd(SteadyNow());
  seen_.lasted_s = watch_.TimeSeconds(SteadyNow());
  CutOff(clock_.EndAll(seen_.lasted_s));
  CutOff(world_clock_.EndAll(world_time_.Now_s()));
  Stop();
  Interrupts::AllowSeconds(kConcluding_s);  // its count is not asked any more
  invariants_.Finish(false);
  NoteBroken();
  NotePauses(SteadyTime::max());
  if (black_box_) black_box_->Finish();
  Gather(&seen_);
  seen_.slopes = resources_.Slopes();
  return std::move(seen_);
}

void SoakSession::Gather(SoakSeen* seen) const {
  seen->courses.assign(watch_.Courses().begin(), watch_.Courses().end());
  seen->broken = broken_;
  seen->broken_counted = invariants_.Judged().Broken();
  seen->ticks_judged = invariants_.TicksJudged();
  seen->ticks_unseen = invariants_.TicksUnseen();
  seen->near_misses = near_.Narrowest();
  seen->near_misses_counted = near_.Count();
  seen->near_misses_by_block = near_by_block_.Counts();
  seen->timing = timing_;
  seen->accounting = accounting_;
  if (rings_) seen->kept_rings = rings_->Kept();
  for (std::size_t i = 0; black_box_ && i < seen->kept_rings.size(); ++i) {
    seen->kept_rings[i].page = black_box_->Written(i);
  }
  seen->slopes = resources_.EndedSlopes();
  seen->supervisor_cpu_share = resources_.SupervisorShare();
  for (const VehicleId vehicle : fleet_) {
    seen->step_p99_us[vehicle] = watch_.HighestStepP99_us(vehicle);
  }
  seen->lives_too_short = resources_.LivesTooShort();
  seen->pauses = {pauses_.Count(), Seconds(pauses_.Paused()), Seconds(pauses_.Longest()),
                  pauses_.Share()};
}

void SoakSession::SaveIfDue(SteadyTime now) {
  if (!save_ || !seen_.started || stopping_ || now < next_save_) return;
  SoakSeen so_far = seen_;
  so_far.lasted_s = watch_.TimeSeconds(now);
  Gather(&so_far);
  // What a fault broke is not known while it is open: active, or its effects not yet settled.
  for (const std::size_t i : watch_.Open()) {
    so_far.courses[i] = {.effect = watch_.Courses()[i].effect};
  }
  next_save_ = now + save_(std::move(so_far));
}

bool SoakSession::WaitUntilAllDrive() {
  const SteadyTime limit = SteadyNow() + kUntilAllDrive;
  while (SteadyNow() < limit && Interrupts::Count() == 0) {
    Turn();
    if (watch_.HasStarted() && watch_.AreAllWell(SteadyNow())) return true;
  }
  for (const VehicleId vehicle : watch_.Unwell(SteadyNow())) {
    const auto& said = processes_.LastLines(MemberOf(vehicle));
    std::fprintf(
        stderr, "vehicle %u does not drive%s%s\n", Number(vehicle),
        said.empty() ? "" : "; the last it said: ", said.empty() ? "" : said.back().c_str());
  }
  return false;
}

void SoakSession::Turn() {
  SleepUntil(SteadyNow() + kTurn);
  const SteadyTime now = SteadyNow();
  pauses_.Note(turned_, now, kTurn);
  turned_ = now;
  NotePauses(now);  // before a fault that is settled is closed
  Drain();
  processes_.Poll();
  NoteEnds();                                                  // before any is started again
  if (!stopping_) faults_.Turn(now, watch_.TimeSeconds(now));  // it starts processes again
  attackers_.Turn();
  for (const VehicleId vehicle : fleet_) {
    watch_.SetAway(vehicle, faults_.IsAway(MemberOf(vehicle)));
  }
  NoteProcessEffects();
  HearLines();
  RestartThoseThatEnded(SteadyNow());
  Sample(now);
  FollowCourse(now);
  ShowProgress(now);
  KeepRings(now);
  SaveIfDue(now);
}

void SoakSession::Drain() {
  const link::Observed observed = observer_.Take();
  world_time_.Follow(observed.truths, SteadyNow());
  watch_.Fold(observed, SteadyNow());
  invariants_.Fold(observed);
  NoteBroken();
  const std::uint64_t near_before = near_.Count();
  near_.Fold(observed.truths, WorldLag_s());
  near_by_block_.Note(watch_.TimeSeconds(SteadyNow()), near_.Count() - near_before);
  if (black_box_) black_box_->Fold(observed, SteadyNow());
  for (const VehicleStatus& status : observed.statuses) {
    timing_.Fold(status, watch_.TimeSeconds(SteadyNow()));
    accounting_.Fold(status);
  }
  if (watch_.HasStarted() && seen_.started_at == SteadyTime{0}) {
    seen_.started_at = SteadyNow() - FromSeconds(watch_.TimeSeconds(SteadyNow()));
  }
}

// Its time falls behind by as long as it is gone, and the faults it carries out with it.
bool SoakSession::IsOver(SteadyTime now) const {
  if (watch_.TimeSeconds(now) < phases_.end_s) return false;
  return world_time_.Now_s() >= phases_.end_s || world_time_.IsGone(now);
}

// Those of a world that does not come back are not waited for: the fleet has to heal all the same.
bool SoakSession::AreFaultsOver(SteadyTime now) const {
  const double since_last_s = watch_.TimeSeconds(now) - clock_.LastEnd_s();
  if (since_last_s < 0) return false;
  return world_time_.Now_s() >= world_clock_.LastEnd_s() ||
         (world_time_.IsGone(now) && since_last_s >= kWorldBack_s);
}

// Of a run that was not interrupted, what keeps it from showing that its fleet heals.
void SoakSession::NoteWhatDidNotEnd(SteadyTime now) {
  if (world_time_.IsGone(now)) {
    seen_.world_stood_from_s = watch_.TimeSeconds(world_time_.MovedAt());
  }
  seen_.faults_outlasted_it = !AreFaultsOver(now);
}

// At once: ticks of another world start again, and its time lags.
void SoakSession::NoteBroken() {
  const auto first = invariants_.Judged().First();
  for (std::size_t i = broken_.size(); i < first.size(); ++i) {
    broken_.push_back({TimeOfTick(first[i].tick), first[i]});
  }
}

void SoakSession::NotePauses(SteadyTime now) {
  watch_.NotePauses(limits_, now, [this](SteadyTime from, SteadyTime to) {
    return stalls_.LongestPause(from, to);
  });
}

// What is known to be broken during the run: invariants, decisions on stale beacons, processes that
// ended.
std::uint64_t SoakSession::BrokenSoFar() const {
  return seen_.restarts + timing_.Stale().size() + invariants_.Judged().Broken();
}

void SoakSession::KeepRings(SteadyTime now) {
  if (!rings_) return;
  const std::uint64_t broken = BrokenSoFar();
  const std::size_t kept_before = rings_->Kept().size();
  if (broken > broken_before_ && !stopping_) rings_->Keep(now, watch_.TimeSeconds(now));
  if (rings_->Kept().size() > kept_before) black_box_->Write();
  broken_before_ = broken;
  rings_->Turn(now);
}

void SoakSession::CarryOut(std::span<const FaultEdge> edges) {
  for (const FaultEdge& edge : edges) {
    const faults::Fault& fault = schedule_[edge.fault];
    if (edge.begins) {
      watch_.NoteBegin(edge.fault, SteadyNow());
      for (const faults::Fault* const cut : faults_.CutShortBy(fault)) {
        watch_.NoteMetNothing(static_cast<std::size_t>(cut - schedule_.data()),
                              "another fault started before the world had answered");
      }
      Begin(edge.fault);
    } else {
      const std::string nothing = faults_.WhyNothingMet(fault);
      if (!nothing.empty()) watch_.NoteMetNothing(edge.fault, nothing);
      for (const std::string& done : {faults_.EffectAtEndOf(fault), attackers_.EffectOf(fault)}) {
        if (!done.empty()) watch_.NoteEffect(edge.fault, done);
      }
      faults_.End(fault);
      attackers_.End(fault);
      watch_.NoteEnd(edge.fault, SteadyNow());
    }
  }
}

void SoakSession::CutOff(std::span<const FaultEdge> edges) {
  CarryOut(edges);
  for (const FaultEdge& edge : edges) watch_.NoteCutOff(edge.fault);
}

// One for which no process can be started has no effect, and the soak continues.
void SoakSession::Begin(std::size_t fault) {
  try {
    faults_.Begin(schedule_[fault]);
    attackers_.Begin(schedule_[fault]);
  } catch (const StartError& error) {
    watch_.NoteFailure(fault, error.what());
  }
}

// The externally visible state of a process: stopped or gone, its limits, the result of an order.
void SoakSession::NoteProcessEffects() {
  for (const std::size_t i : watch_.Open()) {
    const faults::Fault& fault = schedule_[i];
    const bool sought = watch_.Courses()[i].effect.empty() &&
                        faults::ActorOf(fault.kind) == faults::Actor::kSupervisor;
    if (!sought) continue;
    const std::string effect = faults_.EffectOf(fault);
    if (!effect.empty()) watch_.NoteEffect(i, effect);
  }
  for (const QosOrders::Ended& order : faults_.TakeEndedOrders()) {
    const auto i = static_cast<std::size_t>(order.fault - schedule_.data());
    NoteOrder(i, order);
  }
}

// It is in effect where the verb says so; where it does not, its last line says why.
void SoakSession::NoteOrder(std::size_t fault, const QosOrders::Ended& order) {
  const bool back = order.order == QosOrder::kTakeBack;
  if (order.how == ProcessEnd{}) {
    if (back) {
      watch_.AddToEffect(fault, ", and its own again");
    } else {
      watch_.NoteEffect(fault, order.last_line);
    }
    return;
  }
  std::string why = fmt::format("the order{} ended with {}: {}", back ? " back" : "",
                                Describe(order.how), order.last_line);
  // A process that is gone has no set, and comes back with its own.
  const faults::Target& target = schedule_[fault].target;
  const bool gone =
      target.what == Target::What::kVehicle && faults_.IsAway(MemberOf(target.vehicle));
  if (back) {
    watch_.NoteNotUndone(fault, std::move(why), gone);
  } else {
    watch_.NoteFailure(fault, std::move(why));
  }
}

void SoakSession::HearLines() {
  for (const auto& [member, line] : processes_.TakeLines()) {
    if (member.kind != MemberKind::kVehicle) continue;
    if (const auto word = LogEventOf(line)) watch_.Fold(VehicleId{member.number}, *word);
  }
  for (const std::string& complaint : processes_.TakeLogComplaints()) {
    std::fprintf(stderr, "%s\n", complaint.c_str());
  }
}

// A process that was killed as planned is not reported. One that ended otherwise is restarted, as
// by a container's restart policy; its end counts in the verdict.
void SoakSession::NoteEnds() {
  for (const MemberEnd& end : processes_.TakeEnds()) {
    if (!stopping_) resources_.EndLife(ProcessName(end.member));
    if (end.planned) {
      for (const std::size_t i : faults_.KillersOf(end.member, schedule_)) {
        watch_.NoteEffect(i, "the process ended: " + Describe(end.how));
      }
      continue;
    }
    if (!MayEnd(end)) NoteUnplannedEnd(end);
    if (!stopping_) restarts_.NoteEnd(end.member, SteadyNow());
  }
}

// Of a fleet that never drove nothing is judged, and a second interrupt kills those that leave.
bool SoakSession::MayEnd(const MemberEnd& end) const {
  if (stopping_ && (HasLeft(end) || !seen_.started || Interrupts::Count() > 1)) return true;
  const auto aimed = [&](const faults::Fault& fault) {
    return faults_.IsAimedAt(fault, end.member);
  };
  return watch_.MayEndProcess(aimed, SteadyNow());
}

void SoakSession::NoteUnplannedEnd(const MemberEnd& end) {
  const auto& said = processes_.LastLines(end.member);
  NoteUnplannedEnd(end.member, (stopping_ ? "asked to stop, " : "") + Describe(end.how),
                   {said.begin(), said.end()});
}

void SoakSession::NoteUnplannedEnd(MemberId member, std::string how,
                                   std::vector<std::string> last_lines) {
  ++seen_.restarts;
  if (seen_.ends.size() == kMostEnds) return;
  seen_.ends.push_back(
      {watch_.TimeSeconds(SteadyNow()), member, std::move(how), std::move(last_lines)});
}

void SoakSession::NoteFailedStart(const FailedStart& start) {
  NoteUnplannedEnd(start.member, "could not be started again: " + start.why, {});
}

void SoakSession::RestartThoseThatEnded(SteadyTime now) {
  if (stopping_) return;
  for (const FailedStart& start : faults_.TakeFailedStarts()) {
    NoteFailedStart(start);
    restarts_.NoteEnd(start.member, now);
  }
  const auto command = [this](MemberId member) { return faults_.CommandNow(member); };
  for (const FailedStart& start : restarts_.Turn(now, command)) NoteFailedStart(start);
}

void SoakSession::Sample(SteadyTime now) {
  if (now < next_sample_) return;
  next_sample_ = now + kSampleEvery;
  if (!watch_.HasStarted() || stopping_) return;
  const double time_s = watch_.TimeSeconds(now);
  std::vector<pid_t> living;
  const auto sample = [&](MemberId member, std::optional<std::uint64_t> heap_bytes) {
    const auto resources = processes_.ResourcesOf(member);
    if (!resources) return;
    resources_.Add(ProcessName(member), time_s, *resources, heap_bytes);
    living.push_back(*processes_.PidOf(member));
  };
  const std::optional<pid_t> world = processes_.PidOf(kTheWorld);
  sample(kTheWorld, world ? ReadHeap(fmt::format("/proc/{}", *world)) : std::nullopt);
  for (const VehicleId vehicle : fleet_) sample(MemberOf(vehicle), watch_.HeapOf(vehicle, now));
  resources_.AddSupervisor(OwnProcessorSeconds());
  if (++samples_ % kSharedMemoryEvery == 0) {
    resources_.AddSharedMemory(time_s, ReadSharedMemory(living));
  }
}

double SoakSession::WorldLag_s() const {
  return watch_.TimeSeconds(world_time_.ReceivedAt()) - world_time_.Now_s();
}

double SoakSession::TimeOfTick(Tick tick) const {
  const std::optional<Truth>& newest = world_time_.Newest();
  if (!newest) return 0;
  const double ticks =
      static_cast<double>(Number(tick)) - static_cast<double>(Number(newest->tick));
  return std::max(0.0, watch_.TimeSeconds(world_time_.ReceivedAt()) + ticks * tick_period_s_);
}

void SoakSession::FollowCourse(SteadyTime now) {
  if (!watch_.HasStarted() || stopping_) return;
  course_.NoteModes(watch_, now, &seen_);
  if (!seen_.started || !AreFaultsOver(now)) return;
  course_.SeekHealing(watch_, now, &seen_);
}

void SoakSession::ShowProgress(SteadyTime now) {
  if (!seen_.started || stopping_ || now < next_progress_) return;
  next_progress_ = now + kProgressEvery;
  std::size_t begun = 0;
  for (const FaultCourse& course : watch_.Courses()) begun += course.began ? 1 : 0;
  const auto unwell = watch_.Unwell(now);
  std::string names;
  for (const VehicleId vehicle : unwell) names += fmt::format(" {}", Number(vehicle));
  std::fprintf(stderr,
               "%6.0f of %.0f s  faults %zu of %zu, %zu active  invariants broken %lu%s%s\n",
               watch_.TimeSeconds(now), phases_.end_s, begun, schedule_.size(),
               clock_.UnderWay().size() + world_clock_.UnderWay().size(),
               invariants_.Judged().Broken(), names.empty() ? "" : "  not driving:", names.c_str());
}

// The world first, so that it announces the end. Vehicles are asked one by one: each has a second
// to leave, and all of them at once would take longer on a small machine.
void SoakSession::Stop() {
  processes_.Poll();
  NoteEnds();  // those that ended before were not asked to
  stopping_ = true;
  processes_.AskToStop(kTheWorld);
  const auto turn = [this] { Turn(); };
  if (processes_.WaitUntilEnded(kLeaveGrace, turn)) return;
  for (const VehicleId vehicle : fleet_) {
    if (Interrupts::Count() > 1) break;
    processes_.AskToStop(MemberOf(vehicle));
    Turn();
  }
  processes_.EndAll(kTermGrace, turn);
}

}  // namespace giveway::fleetctl
