#include "sim_world/run/admission.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/types/time.h"

namespace giveway::sim {
namespace {

// Long enough for a process that died to fall silent and for its body to stop, before another is
// refused because its id is taken; and for a waiting process to ask again.
constexpr Nanoseconds kPatience{3'000'000'000};
constexpr double kStill_rad_s = 1e-9;

bool NoWheelTurns(const Body& body) {
  return std::abs(body.wheels.left_rad_s) + std::abs(body.wheels.right_rad_s) < kStill_rad_s;
}

}  // namespace

Admission::Admission(const Scenario& scenario, WorldEpoch epoch, Run* run)
    : run_(*run),
      open_(IsOpen(scenario)),
      patience_ticks_(TicksCovering(kPatience, scenario.tick_period)),
      roster_(scenario, epoch) {}

void Admission::Take(const JoinRequest& request) {
  if (request.leaving) return Leave(request.session);
  const auto waiting = std::ranges::find_if(
      waiting_, [&](const Waiting& w) { return w.request.session == request.session; });
  if (waiting != waiting_.end()) {
    waiting->asked = run_.Now();
  } else if (waiting_.size() < kMostWaiting || roster_.SlotOf(request.session) != nullptr) {
    waiting_.push_back({request, run_.Now(), run_.Now(), ""});
  } else {
    ++passed_over_;
  }
}

void Admission::Leave(const SessionId& session) {
  std::erase_if(waiting_, [&](const Waiting& w) { return w.request.session == session; });
  const Slot* slot = roster_.SlotOf(session);
  if (slot == nullptr) return;
  const VehicleId vehicle = slot->vehicle;
  run_.Leave(vehicle);
  roster_.Free(vehicle);
  informed_.erase(vehicle);
  gone_.push_back(vehicle);
}

void Admission::FollowRun() {
  for (const WorldEvent& event : run_.Events()) {
    if (event.kind != EventKind::kRemoved) continue;
    roster_.Free(event.vehicle);
    gone_.push_back(event.vehicle);
    const auto informed = informed_.find(event.vehicle);
    if (informed == informed_.end()) continue;
    // If it is still there and received nothing until now, it may ask again.
    RosterEntry gone = informed->second;
    gone.accepted = false;
    gone.waiting = true;
    gone.reason = "the body was taken away after a silence";
    answers_.push_back(std::move(gone));
    informed_.erase(informed);
  }
}

std::vector<VehicleId> Admission::TakeGone() { return std::exchange(gone_, {}); }

std::vector<RosterEntry> Admission::Answer() {
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    Result result = Try(&*waiting);
    if (result.answer) answers_.push_back(*std::move(result.answer));
    waiting = result.waits ? waiting + 1 : waiting_.erase(waiting);
  }
  for (RosterEntry& entry : answers_) entry.run_state = run_.State();
  return std::exchange(answers_, {});
}

Admission::Result Admission::Try(Waiting* waiting) {
  const JoinRequest& request = waiting->request;
  // Its body from an earlier epoch still rolls: a pose sent now would soon be wrong.
  if (const Slot* slot = roster_.SlotOf(request.session)) {
    const auto informed = informed_.find(slot->vehicle);
    if (informed != informed_.end()) {
      run_.AsksAgain(slot->vehicle);
      run_.Locate(roster_.OptionsOf(*slot), &informed->second);
      return {.waits = false, .answer = informed->second};
    }
    const Body* body = run_.BodyOf(slot->vehicle);
    if (body != nullptr && !NoWheelTurns(*body)) return {.waits = true, .answer = {}};
  }
  RosterEntry entry = roster_.Admit(
      request, {.is_silent = [this](VehicleId vehicle) { return MayTakeOver(vehicle); },
                .is_free = [this](const VehicleOptions& options) { return IsFree(options); }});
  if (entry.accepted) {
    LetIn(std::move(entry));
    return {.waits = false, .answer = {}};
  }
  // In an open fleet a place may become free at any time; a particular id is not worth that wait.
  const bool forever = open_ && request.wanted == kNoVehicle;
  const bool forgotten = TicksBetween(waiting->asked, run_.Now()) >= patience_ticks_;
  if (forever && forgotten) return {.waits = false, .answer = {}};
  const bool over = !forever && TicksBetween(waiting->since, run_.Now()) >= patience_ticks_;
  if (over) entry.waiting = false;
  if (entry.waiting && entry.reason == waiting->last_reason) return {.waits = true, .answer = {}};
  waiting->last_reason = entry.reason;
  const bool waits = entry.waiting;
  return {.waits = waits, .answer = std::move(entry)};
}

void Admission::LetIn(RosterEntry entry) {
  const VehicleOptions options = roster_.OptionsOf(*roster_.SlotOf(entry.session));
  run_.Join(options);
  run_.Locate(options, &entry);
  answers_.push_back(entry);
  const auto before = informed_.find(entry.vehicle);
  if (before != informed_.end()) {
    answers_.push_back(before->second);
    answers_.back().accepted = false;
    answers_.back().reason = "another session took its place after a silence";
  }
  informed_[entry.vehicle] = std::move(entry);
}

bool Admission::MayTakeOver(VehicleId vehicle) const {
  const Body* body = run_.BodyOf(vehicle);
  return run_.IsAbandoned(vehicle) && (body == nullptr || NoWheelTurns(*body));
}

// If its own body still stands, nothing is put on the start pose.
bool Admission::IsFree(const VehicleOptions& options) const {
  return run_.BodyOf(options.id) != nullptr || run_.IsFree(options);
}

std::vector<RosterEntry> Admission::InformAll(const std::string& reason) {
  std::vector<RosterEntry> entries;
  for (auto& [vehicle, entry] : informed_) {
    if (const Slot* slot = roster_.SlotOf(entry.session)) {
      run_.Locate(roster_.OptionsOf(*slot), &entry);
    }
    entry.run_state = run_.State();
    entry.reason = reason;
    entries.push_back(entry);
  }
  return entries;
}

std::vector<VehicleId> Admission::Expected() const {
  std::vector<VehicleId> expected;
  for (const Slot& slot : roster_.Slots()) {
    if (slot.taken) expected.push_back(slot.vehicle);
  }
  return expected;
}

FleetCheckpoint Admission::Save(std::uint64_t scenario) const {
  return {.scenario = scenario,
          .run = run_.Save(),
          .slots = {roster_.Slots().begin(), roster_.Slots().end()}};
}

bool Admission::Restore(const FleetCheckpoint& checkpoint) {
  if (!roster_.Restore(checkpoint.slots)) return false;
  std::vector<VehicleOptions> joined;
  for (const Slot& slot : checkpoint.slots) {
    if (slot.spawn != 0) joined.push_back(roster_.OptionsOf(slot));
  }
  return run_.Restore(checkpoint.run, joined);
}

}  // namespace giveway::sim
