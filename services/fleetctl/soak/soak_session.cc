#include "services/fleetctl/soak/soak_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/process/process_resources.h"
#include "services/fleetctl/process/run_key.h"
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
constexpr Nanoseconds kWorldGone = seconds(60);  // its time stands: it is not waited for any more
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

std::map<VehicleId, double> RadiiOf(const Scenario& scenario, const std::vector<VehicleId>& fleet) {
  double largest_m = 0;
  for (const VehicleOptions& spawn : scenario.spawns) {
    largest_m = std::max(largest_m, spawn.profile.body_radius_m);
  }
  std::map<VehicleId, double> radius_m;
  for (const VehicleId vehicle : fleet) radius_m[vehicle] = largest_m;
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    radius_m[vehicle.id] = vehicle.profile.body_radius_m;
  }
  return radius_m;
}

Nanoseconds MostBeaconAge(const Scenario& scenario) {
  Nanoseconds limit{0};
  for (const auto& vehicle : scenario.vehicles) limit = std::max(limit, vehicle.beacon_age_limit);
  for (const auto& spawn : scenario.spawns) limit = std::max(limit, spawn.beacon_age_limit);
  return limit + scenario.tick_period;
}

std::vector<VehicleId> SoakFleet(const Scenario& scenario, std::uint32_t newcomers) {
  std::vector<VehicleId> fleet;
  for (const VehicleOptions& vehicle : scenario.vehicles) fleet.push_back(vehicle.id);
  for (std::uint32_t id = 1; id <= newcomers; ++id) fleet.push_back(VehicleId{id});
  return fleet;
}

SoakSession::SoakSession(const FleetSpec& spec, const Scenario& scenario,
                         const faults::Schedule& schedule, const SoakPhases& phases,
                         FaultTools tools)
    : schedule_(schedule),
      phases_(phases),
      fleet_(SoakFleet(scenario, NewcomerCount(spec.options, scenario))),
      watch_(fleet_, schedule),
      invariants_(scenario),
      own_link_(ObserverOf(spec, scenario, tools.shm != nullptr)),
      observer_(own_link_, RangesFor(spec)),
      processes_(tools.commands),
      attackers_({tools.attacker, tools.domain, tools.interface}),
      faults_(std::move(tools), &processes_),
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
      CarryOut(world_clock_.TakeDue(WorldSeconds()));
    }
  }
  seen_.interrupted = Interrupts::Count() > 0;
  seen_.lasted_s = watch_.TimeSeconds(SteadyNow());
  CarryOut(clock_.EndAll(seen_.lasted_s));
  CarryOut(world_clock_.EndAll(WorldSeconds()));
  Stop();
  Interrupts::AllowSeconds(kConcluding_s);  // its count is not asked any more
  invariants_.Finish(false);
  NoteBroken();
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
  Drain();
  processes_.Poll();
  NoteEnds();  // before any is started again
  faults_.Turn(now, watch_.TimeSeconds(now));
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
  FollowWorld(observed, SteadyNow());
  watch_.Fold(observed, SteadyNow());
  invariants_.Fold(observed);
  NoteBroken();
  const std::uint64_t near_before = near_.Count();
  near_.Fold(observed.truths);
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

void SoakSession::FollowWorld(const link::Observed& observed, SteadyTime now) {
  if (observed.truths.empty()) return;
  const Truth& newest = observed.truths.back();
  if (!any_truth_ || newest.time_s > any_truth_->time_s) world_moved_ = now;
  any_truth_ = newest;
  truth_at_ = now;
}

double SoakSession::WorldSeconds() const { return any_truth_ ? any_truth_->time_s : 0; }

// Its time falls behind by as long as it is gone, and the faults it carries out with it.
bool SoakSession::IsOver(SteadyTime now) const {
  if (watch_.TimeSeconds(now) < phases_.end_s) return false;
  return WorldSeconds() >= phases_.end_s || now - world_moved_ > kWorldGone;
}

bool SoakSession::AreFaultsOver(SteadyTime now) const {
  return watch_.TimeSeconds(now) >= clock_.LastEnd_s() &&
         WorldSeconds() >= world_clock_.LastEnd_s();
}

// At once: ticks of another world start again, and its time lags.
void SoakSession::NoteBroken() {
  const auto first = invariants_.Judged().First();
  for (std::size_t i = broken_.size(); i < first.size(); ++i) {
    broken_.push_back({TimeOfTick(first[i].tick), first[i]});
  }
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
      faults_.Begin(fault);
      attackers_.Begin(fault);
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
  watch_.NoteFailure(fault, fmt::format("the order{} ended with {}: {}", back ? " back" : "",
                                        Describe(order.how), order.last_line));
}

void SoakSession::HearLines() {
  for (const auto& [member, line] : processes_.TakeLines()) {
    if (member.kind != MemberKind::kVehicle) continue;
    if (const auto word = LogEventOf(line)) watch_.Fold(VehicleId{member.number}, *word);
  }
}

// A process that was killed as planned is not reported. One that ended otherwise is restarted, as
// by a container's restart policy; its end counts in the verdict.
void SoakSession::NoteEnds() {
  for (const MemberEnd& end : processes_.TakeEnds()) {
    if (stopping_) continue;
    resources_.EndLife(ProcessName(end.member));
    if (end.planned) {
      for (const std::size_t i : faults_.KillersOf(end.member, schedule_)) {
        watch_.NoteEffect(i, "the process ended: " + Describe(end.how));
      }
      continue;
    }
    const auto aimed = [&](const faults::Fault& fault) {
      return faults_.IsAimedAt(fault, end.member);
    };
    if (!watch_.MayEndProcess(aimed, SteadyNow())) {
      ++seen_.restarts;
      if (seen_.ends.size() < kMostEnds) {
        const auto& said = processes_.LastLines(end.member);
        seen_.ends.push_back({watch_.TimeSeconds(SteadyNow()),
                              end.member,
                              Describe(end.how),
                              {said.begin(), said.end()}});
      }
    }
    restart_at_[end.member] = backoff_.StartOf(end.member, SteadyNow());
  }
}

void SoakSession::RestartThoseThatEnded(SteadyTime now) {
  if (stopping_) return;
  std::erase_if(restart_at_, [&](const auto& restart) {
    const auto& [member, at] = restart;
    if (now < at) return false;
    if (!processes_.IsRunning(member)) processes_.Restart(faults_.CommandNow(member));
    return true;
  });
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

double SoakSession::TimeOfTick(Tick tick) const {
  if (!any_truth_) return 0;
  const double ticks =
      static_cast<double>(Number(tick)) - static_cast<double>(Number(any_truth_->tick));
  return std::max(0.0, watch_.TimeSeconds(truth_at_) + ticks * tick_period_s_);
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

// The world first, so that it announces the end and the vehicles leave gracefully.
void SoakSession::Stop() {
  stopping_ = true;
  processes_.AskToStop(kTheWorld);
  const auto turn = [this] { Turn(); };
  if (!processes_.WaitUntilEnded(kLeaveGrace, turn)) processes_.EndAll(kTermGrace, turn);
}

}  // namespace giveway::fleetctl
