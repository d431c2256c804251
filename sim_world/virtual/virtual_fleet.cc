#include "sim_world/virtual/virtual_fleet.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "services/types/check.h"
#include "services/types/time.h"
#include "sim_world/virtual/virtual_faults.h"

namespace giveway::sim {
namespace {

constexpr WorldEpoch kVirtualEpoch{1};
constexpr std::ptrdiff_t kReaderDepth = 4;  // beacons a paused reader keeps of one peer

// To the world a crash is the same as a planned kill.
Scenario WithCrashes(Scenario scenario, const VirtualPlan& plan) {
  for (const ProcessFault& fault : plan.faults) {
    if (fault.kind != ProcessFaultKind::kCrash) continue;
    scenario.faults.push_back(
        {.kind = FaultKind::kKill, .vehicle = fault.vehicle, .at_s = fault.at_s});
  }
  return scenario;
}

// Cheaper than a byte-wise hash: it is fed twice a vehicle and tick.
std::uint64_t Stir(std::uint64_t hash, double value) {
  hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0xd1342543de82ef95ULL;
  return hash ^ (hash >> 29U);
}

}  // namespace

VirtualFleet::VirtualFleet(const Scenario& scenario, const VirtualPlan& plan)
    : plan_(Translated(plan, scenario)),
      scenario_(WithCrashes(scenario, plan_)),
      run_(scenario_, kVirtualEpoch, OnThisThread, {plan_.schedule, plan_.seed}),
      radio_(scenario_, plan_.radio, plan_.seed) {
  for (const VehicleOptions& options : scenario_.vehicles) {
    run_.Join(options.id);
    Member& member = members_.emplace_back();
    member.id = options.id;
    member.brain = std::make_unique<Vehicle>(options, ++last_boot_epoch_);
  }
  for (std::size_t i = 0; i < plan_.faults.size(); ++i) {
    const ProcessFault& fault = plan_.faults[i];
    Member* member = Find(fault.vehicle);
    GIVEWAY_CHECK(member != nullptr, Number(fault.vehicle));
    if (fault.kind == ProcessFaultKind::kCrash) continue;
    auto& due = i < plan.faults.size() ? faults_ : scheduled_;
    due.push_back({fault, static_cast<std::size_t>(member - members_.data())});
  }
  std::ranges::stable_sort(scheduled_, {}, [](const DueFault& due) { return due.fault.at_s; });
  places_.resize(members_.size());
  commands_.reserve(members_.size());
  run_.Start();
}

VirtualFleet::Member* VirtualFleet::Find(VehicleId vehicle) {
  const auto found = std::ranges::lower_bound(members_, vehicle, {}, &Member::id);
  return found == members_.end() || found->id != vehicle ? nullptr : &*found;
}

void VirtualFleet::CarryOutFaults() {
  for (const WorldEvent& event : run_.Events()) {
    history_.push_back(event);
    if (event.kind != EventKind::kFaultDue || event.text != "kill") continue;
    if (Member* member = Find(event.vehicle)) {
      member->process = Process::kGone;
      member->back_at_tick = 0;
    }
  }
  for (DueFault& due : faults_) {
    if (!due.done) CarryOut(&due);
  }
  while (next_scheduled_ < scheduled_.size()) {
    DueFault& due = scheduled_[next_scheduled_];
    if (run_.TimeSeconds() < due.fault.at_s) break;
    EndPauseOf(due.member);
    CarryOut(&due);
    ++next_scheduled_;
  }
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const std::uint32_t back_at = members_[i].back_at_tick;
    if (back_at != 0 && Number(run_.Now()) >= back_at) BringBack(i);
  }
}

// Two faults of a schedule exclude each other on one process: one that started before is over,
// though in whole ticks it may have one to go.
void VirtualFleet::EndPauseOf(std::size_t index) {
  const Member& member = members_[index];
  const bool is_over = member.back_at_tick != 0 && Number(run_.Now()) + 1 >= member.back_at_tick;
  if (member.process == Process::kPaused && is_over) BringBack(index);
}

void VirtualFleet::CarryOut(DueFault* due) {
  if (run_.TimeSeconds() < due->fault.at_s) return;
  due->done = true;
  Break(due->fault, &members_[due->member]);
}

void VirtualFleet::Break(const ProcessFault& fault, Member* member) {
  if (member->process != Process::kRuns) return;
  if (fault.kind == ProcessFaultKind::kSlow) {
    member->slow_since_tick = Number(run_.Now());
    member->slow_until_tick =
        member->slow_since_tick + TicksCovering(FromSeconds(fault.for_s), scenario_.tick_period);
    member->share = fault.share;
    return;
  }
  member->restarts = fault.kind == ProcessFaultKind::kRestart;
  member->process = member->restarts ? Process::kGone : Process::kPaused;
  member->back_at_tick = Number(run_.Now()) + std::max(1U, TicksCovering(FromSeconds(fault.for_s),
                                                                         scenario_.tick_period));
}

// Answers this share of n ticks, spread as evenly as whole ticks allow.
bool VirtualFleet::Skips(const Member& member) const {
  const std::uint32_t now = Number(run_.Now());
  if (now >= member.slow_until_tick) return false;
  const std::uint32_t n = now - member.slow_since_tick;
  const auto answered = [&](std::uint32_t ticks) {
    return static_cast<std::uint32_t>(member.share * ticks);
  };
  return answered(n + 1) == answered(n);
}

// Whether the vehicle has a body: one whose body was removed while it was silent gets another on
// its start pose as soon as that is free.
bool VirtualFleet::IsThere(const VehicleOptions& options) {
  if (run_.BodyOf(options.id) != nullptr) return true;
  if (!run_.IsFree(options)) return false;
  run_.Join(options);
  return true;
}

// A new process is sent the pose of its body and the progress of its task, as by the world's
// roster; so is one that was paused until its body was removed.
void VirtualFleet::BringBack(std::size_t index) {
  Member& member = members_[index];
  member.restarts = member.restarts || run_.BodyOf(member.id) == nullptr;
  if (!IsThere(scenario_.vehicles[index])) return;
  member.process = Process::kRuns;
  member.back_at_tick = 0;
  if (!member.restarts) return;
  const VehicleOptions& options = scenario_.vehicles[index];
  member.brain = std::make_unique<Vehicle>(options, ++last_boot_epoch_);
  RosterEntry& entry = member.placed.emplace();
  entry = {.vehicle = options.id, .accepted = true, .epoch = kVirtualEpoch};
  run_.Locate(options, &entry);
  member.queued.clear();
  member.fix.reset();
  member.slow_until_tick = 0;
}

void VirtualFleet::UpdateRadioPositions() {
  std::size_t index = 0;
  for (const Truth& truth : run_.Truths()) {
    while (index < members_.size() && members_[index].id != truth.vehicle) ++index;
    if (index == members_.size()) break;
    places_[index] = {.position_world = truth.world_from_body.position_world,
                      .on_air = truth.present && members_[index].process == Process::kRuns};
  }
  radio_.BeginTick(run_.Now(), run_.TimeSeconds(), places_);
}

void VirtualFleet::Think() {
  commands_.clear();
  for (Member& member : members_) member.answered = false;
  for (const PoseFix& fix : run_.PoseFixes()) {
    if (Member* member = Find(fix.vehicle)) member->fix = fix;
  }
  std::size_t index = 0;
  for (const RangeScan& scan : run_.Scans()) {
    while (index < members_.size() && members_[index].id != scan.vehicle) ++index;
    if (index == members_.size()) break;
    const Member& member = members_[index];
    const bool skips = member.process == Process::kRuns && Skips(member);
    if (skips || member.process == Process::kPaused) {
      Queue(index);
    } else if (member.process == Process::kRuns) {
      Step(scan, index);
    }
  }
}

void VirtualFleet::Step(const RangeScan& scan, std::size_t index) {
  Member& member = members_[index];
  heard_.clear();
  events_.clear();
  inputs_.now = Number(scan.tick) * scenario_.tick_period;
  if (!member.queued.empty()) {
    heard_.assign(member.queued.begin(), member.queued.end());
    for (ReceivedBeacon& received : heard_) received.received = inputs_.now;  // taken out only now
    member.queued.clear();
  }
  radio_.Hear(index, &heard_);
  radio_.Notice(index, &events_);
  inputs_.roster = std::exchange(member.placed, std::nullopt);
  inputs_.scan = scan;
  inputs_.pose_fix = std::exchange(member.fix, std::nullopt);
  inputs_.beacons = heard_;
  inputs_.events = events_;
  inputs_.signals = run_.Signals();
  member.outputs = member.brain->Step(inputs_);
  member.answered = true;
  radio_.Transmit(index, scan.tick, member.outputs.beacon);
  commands_.push_back(member.outputs.command);
  commands_hash_ = Stir(commands_hash_, member.outputs.command.target.left_rad_s);
  commands_hash_ = Stir(commands_hash_, member.outputs.command.target.right_rad_s);
}

// A paused process takes nothing: the newest few beacons of each peer wait in its reader.
void VirtualFleet::Queue(std::size_t index) {
  std::vector<ReceivedBeacon>& queued = members_[index].queued;
  heard_.clear();
  radio_.Hear(index, &heard_);
  for (const ReceivedBeacon& received : heard_) {
    const auto same = [&](const ReceivedBeacon& other) { return other.writer == received.writer; };
    if (std::ranges::count_if(queued, same) >= kReaderDepth) {
      queued.erase(std::ranges::find_if(queued, same));
    }
    queued.push_back(received);
  }
}

bool VirtualFleet::HasMetBeacons(const faults::Fault& fault) const {
  return radio_.HasActed(DrawsOf(fault));
}

bool VirtualFleet::Advance() {
  run_.Advance(commands_);
  CarryOutFaults();
  UpdateRadioPositions();
  Think();
  return run_.State() != RunState::kEnded;
}

void VirtualFleet::Finish() {
  while (Advance()) {
  }
}

}  // namespace giveway::sim
