#include "services/fleetctl/soak/soak_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "services/fleetctl/soak/soak_verdict.h"

namespace giveway::fleetctl {
namespace {

using faults::Kind;
using faults::Target;
using std::chrono::seconds;

constexpr double kMoves_m_s = 0.01;
constexpr Nanoseconds kAfterwards = seconds(10);
constexpr Nanoseconds kGivenUp = seconds(120);
// A status has the counts up to its publication; it may arrive a little after the fault's end.
constexpr Nanoseconds kStatusUnderway = seconds(2);
// A pause is known once it is over.
constexpr Nanoseconds kPauseKnown = seconds(1);

// Packets that no library sends. Those without an RTPS header belong to floods, and sequence
// numbers jump for other reasons too.
std::uint64_t MalformedOf(const PacketCounters& packets) {
  return packets.Dropped() - packets.Of(PacketDrop::kForeignSource) -
         packets.Of(PacketDrop::kNotRtps) - packets.Of(PacketDrop::kSequenceJump);
}

// The counter that shows each kind of fault: of the receiver for its impairments, of the peers that
// refuse it for a set that does not match, of the target for an intruder's packets.
std::uint64_t CountOf(Kind kind, const VehicleStatus& status) {
  switch (kind) {
    case Kind::kLoss:
      return status.impaired.dropped_loss;
    case Kind::kBurst:
      return status.impaired.dropped_burst;
    case Kind::kDelay:
      return status.impaired.delayed;
    case Kind::kReorder:
      return status.impaired.held_back;
    case Kind::kDuplicate:
      return status.impaired.duplicated;
    case Kind::kCorrupt:
      return status.impaired.corrupted;
    case Kind::kRate:  // other faults may leave less than the limit of what is sent
      return status.impaired.metered;
    case Kind::kQosMismatch:
      return status.qos.incompatible_qos;
    case Kind::kSpoofed:  // the beacon names another vehicle, which may be the one that counts
      return std::uint64_t{status.beacons.rejected_wrong_name} + status.beacons.rejected_own;
    case Kind::kFlooded:
      return status.packets.Of(PacketDrop::kNotRtps);
    case Kind::kMalformed:
      return MalformedOf(status.packets);
    default:  // a cut; other faults drop packets meanwhile for their own causes
      return status.impaired.dropped_blackout;
  }
}

// Whether a counter of some vehicle shows it.
bool ShowsInCounters(Kind kind) {
  switch (faults::ActorOf(kind)) {
    case faults::Actor::kHearer:
      return true;
    case faults::Actor::kAttacker:
      return kind != Kind::kReplayed;  // the library drops duplicates without counting them
    case faults::Actor::kSupervisor:
      return kind == Kind::kQosMismatch;
    case faults::Actor::kWorld:
      break;
  }
  return false;
}

// How likely it acts on a packet that its receiver is given; nothing of a cut, which takes them
// all, and of what no receiver carries out.
std::optional<double> ShareOf(const faults::Fault& fault) {
  const double share = fault.parameters.probability.value_or(0);
  switch (fault.kind) {
    case Kind::kLoss:
    case Kind::kReorder:
    case Kind::kDuplicate:
    case Kind::kCorrupt:
      return share;
    case Kind::kBurst:  // each takes several
      return share / fault.parameters.count.value_or(1);
    case Kind::kDelay:
    case Kind::kRate:
      return 1;
    default:
      return std::nullopt;
  }
}

// Why a fault that acted on no packet may have met too few: another one kept them away, or it was
// short and acts on few. Empty where that is no chance.
std::string WhyNoneMet(const faults::Fault& fault, const ImpairmentCounters& before,
                       const ImpairmentCounters& after) {
  constexpr double kNoChance = 1e-4;  // a soak has hundreds of faults
  const std::optional<double> share = ShareOf(fault);
  if (!share || fault.target.what != Target::What::kVehicle) return "";
  const std::uint64_t had = before.packets - before.dropped_blackout;
  const std::uint64_t has = after.packets - after.dropped_blackout;
  const std::uint64_t met = has < had ? has : has - had;  // a new life counts from 0
  if (std::pow(1 - *share, static_cast<double>(met)) < kNoChance) return "";
  return fmt::format("it met {} packets, and acts on a share of {:g}", met, *share);
}

// As the world names it in its events.
std::string NameInEvents(const faults::Fault& fault) {
  return fmt::format("{} {} of {}", faults::ToString(fault.kind), fault.nth, fault.rule);
}

std::string_view CounterOf(Kind kind) {
  switch (kind) {
    case Kind::kQosMismatch:
      return "endpoints of incompatible QoS";
    case Kind::kSpoofed:
      return "beacons refused for their name";
    case Kind::kFlooded:
    case Kind::kMalformed:
      return "packets dropped by its filter";
    default:
      return "packets";
  }
}

}  // namespace

bool IsWell(const VehicleStatus& status) {
  const Decision& decision = status.decision;
  if (decision.mode == Mode::kHalt || decision.mode == Mode::kLeaving) return false;
  switch (decision.rule) {
    case Rule::kNotRunning:
    case Rule::kRangesStale:
    case Rule::kLeaving:
    case Rule::kPeerLost:
    case Rule::kUnidentifiedMotion:
      return false;
    case Rule::kCruise:
      return std::abs(status.forward_m_s) > kMoves_m_s;
    default:
      return true;
  }
}

SoakWatch::SoakWatch(const std::vector<VehicleId>& fleet, std::span<const faults::Fault> schedule)
    : schedule_(schedule), courses_(schedule.size()), before_(schedule.size()) {
  for (const VehicleId vehicle : fleet) views_[vehicle];
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    if (faults::ActorOf(schedule[i].kind) == faults::Actor::kWorld) {
      of_world_.emplace(NameInEvents(schedule[i]), i);
    }
  }
}

void SoakWatch::Fold(const link::Observed& observed, SteadyTime now) {
  refused_ += observed.refused;
  for (const Truth& truth : observed.truths) {
    if (!started_ && truth.time_s >= 0) started_ = now - FromSeconds(truth.time_s);
    const auto view = views_.find(truth.vehicle);
    if (view != views_.end()) view->second.truth = truth;
  }
  for (const WorldEvent& event : observed.events) FoldEvent(event);
  for (const VehicleStatus& status : observed.statuses) FoldStatus(status, now);
  SeekRecovery(now);
  CloseSettled(now);
}

void SoakWatch::FoldStatus(const VehicleStatus& status, SteadyTime now) {
  const auto found = views_.find(status.vehicle);
  if (found == views_.end() || status.final) return;
  found->second.status = status;
  found->second.status_at = now;
  found->second.step_p99_us = std::max(found->second.step_p99_us, status.step_p99_us);
  for (const std::size_t i : open_) {
    const FaultCourse& course = courses_[i];
    if (!course.effect.empty()) continue;
    if (course.ended && now > *course.ended + kStatusUnderway) continue;
    SeekEffect(i, status);
  }
}

// The world reports its own faults.
void SoakWatch::FoldEvent(const WorldEvent& event) {
  if (event.kind != EventKind::kFaultBegan) return;
  const auto named = of_world_.find(event.text);
  if (named == of_world_.end()) return;
  std::string& effect = courses_[named->second].effect;
  if (effect.empty()) effect = "the world reports that the fault started";
}

// A partition is visible from both sides: from the target, and from the peers that lost it. What is
// sent in the target's name is received by its peers.
bool SoakWatch::Concerns(const faults::Fault& fault, VehicleId vehicle) const {
  if (fault.kind == Kind::kSpoofed) return fault.target.vehicle != vehicle;
  return fault.target.what != Target::What::kVehicle || fault.target.vehicle == vehicle ||
         fault.kind == Kind::kPartition || fault.kind == Kind::kFlapping ||
         fault.kind == Kind::kQosMismatch;
}

void SoakWatch::SeekEffect(std::size_t i, const VehicleStatus& status) {
  const faults::Fault& fault = schedule_[i];
  if (!ShowsInCounters(fault.kind) || !Concerns(fault, status.vehicle)) return;
  const auto before = before_[i].find(status.vehicle);
  if (before == before_[i].end()) {
    before_[i][status.vehicle] = status;
    return;
  }
  const std::uint64_t was = CountOf(fault.kind, before->second);
  const std::uint64_t is = CountOf(fault.kind, status);
  if (is < was) {  // a new life of it
    before->second = status;
  } else if (is == was) {
    std::string why;
    if (courses_[i].ended) why = WhyNoneMet(fault, before->second.impaired, status.impaired);
    if (!why.empty()) NoteMetNothing(i, std::move(why));
  } else {
    courses_[i].effect = fmt::format("vehicle {} counted {} {}", Number(status.vehicle), is - was,
                                     CounterOf(fault.kind));
  }
}

void SoakWatch::Fold(VehicleId by, const LogEvent& word) {
  for (const std::size_t i : open_) {
    const faults::Fault& fault = schedule_[i];
    FaultCourse& course = courses_[i];
    if (word.at < *course.began) continue;
    if (word.kind == LogEventKind::kHangs && fault.kind == Kind::kHang &&
        fault.target.vehicle == by && course.effect.empty()) {
      course.effect = "its log says that it hangs";
    }
    const std::optional<Mechanism> mechanism = MechanismOf(word.kind);
    if (!mechanism || by == word.about) continue;
    if (course.ended && word.at > *course.ended + kAfterwards && fault.for_s > 0) continue;
    if (fault.target.what != Target::What::kVehicle || fault.target.vehicle != word.about) continue;
    std::optional<SteadyTime>& noticed = course.noticed[static_cast<std::size_t>(*mechanism)];
    if (!noticed) noticed = word.at;
  }
}

void SoakWatch::NoteBegin(std::size_t fault, SteadyTime now) {
  courses_[fault].began = now;
  open_.push_back(fault);
  if (schedule_[fault].for_s <= 0) courses_[fault].ended = now;
  for (const auto& [vehicle, view] : views_) {
    if (view.status) before_[fault][vehicle] = *view.status;
  }
}

void SoakWatch::NoteEnd(std::size_t fault, SteadyTime now) { courses_[fault].ended = now; }

void SoakWatch::NoteEffect(std::size_t fault, std::string effect) {
  if (courses_[fault].effect.empty()) courses_[fault].effect = std::move(effect);
  courses_[fault].failure.clear();
}

void SoakWatch::AddToEffect(std::size_t fault, const std::string& more) {
  if (!courses_[fault].effect.empty()) courses_[fault].effect += more;
  courses_[fault].failure.clear();
  courses_[fault].not_undone = false;
}

void SoakWatch::NotePauses(const Limits& limits, SteadyTime now, const LongestPause& longest) {
  for (const std::size_t i : open_) {
    FaultCourse& course = courses_[i];
    for (const Expected& expected : ExpectedOf(schedule_[i], limits)) {
      auto& paused = course.paused[static_cast<std::size_t>(expected.mechanism)];
      const SteadyTime latest = LatestReport(*course.began, expected);
      if (!paused && now >= latest + kPauseKnown) paused = longest(*course.began, latest);
    }
  }
}

void SoakWatch::SetAway(VehicleId vehicle, bool away) {
  View& view = views_[vehicle];
  if (away) view.status.reset();
  view.away = away;
}

double SoakWatch::TimeSeconds(SteadyTime now) const {
  return started_ ? std::max(0.0, Seconds(now - *started_)) : 0;
}

bool SoakWatch::IsWell(VehicleId vehicle, SteadyTime now) const {
  const auto view = views_.find(vehicle);
  return view != views_.end() && view->second.status && now - view->second.status_at <= kFresh &&
         fleetctl::IsWell(*view->second.status);
}

std::vector<VehicleId> SoakWatch::Unwell(SteadyTime now) const {
  std::vector<VehicleId> unwell;
  for (const auto& [vehicle, view] : views_) {
    if (!view.away && !IsWell(vehicle, now)) unwell.push_back(vehicle);
  }
  return unwell;
}

std::uint32_t SoakWatch::Living() const {
  return static_cast<std::uint32_t>(
      std::ranges::count_if(views_, [](const auto& view) { return !view.second.away; }));
}

bool SoakWatch::AreAllWell(SteadyTime now) const { return Living() > 0 && Unwell(now).empty(); }

// Later log lines or statuses have other causes. A fault that never recovers is given up.
void SoakWatch::CloseSettled(SteadyTime now) {
  std::erase_if(open_, [&](std::size_t i) {
    const FaultCourse& course = courses_[i];
    if (!course.ended || now < *course.ended + kAfterwards) return false;
    const bool recovers = schedule_[i].kind != Kind::kKill;
    if (recovers && !course.recovered && now < *course.ended + kGivenUp) return false;
    before_[i].clear();
    return true;
  });
}

// The vehicle that the fault affects must be well again; after a fault of no single vehicle, all.
void SoakWatch::SeekRecovery(SteadyTime now) {
  for (const std::size_t i : open_) {
    FaultCourse& course = courses_[i];
    if (!course.ended || course.recovered || schedule_[i].kind == Kind::kKill) continue;
    if (now - *course.ended < kFresh / 2) continue;  // reports from before its end do not count
    const Target& target = schedule_[i].target;
    const bool of_one = target.what == Target::What::kVehicle;
    const auto view = views_.find(target.vehicle);
    if (of_one && (view == views_.end() || view->second.status_at <= *course.ended)) continue;
    if (of_one ? IsWell(target.vehicle, now) : AreAllWell(now)) course.recovered = now;
  }
}

bool SoakWatch::MayEndProcess(const std::function<bool(const faults::Fault&)>& aimed,
                              SteadyTime now) const {
  return std::ranges::any_of(open_, [&](std::size_t i) {
    const Kind kind = schedule_[i].kind;
    const bool ends_some =
        kind == Kind::kMemoryLimit || kind == Kind::kDescriptorLimit || kind == Kind::kQosMismatch;
    const std::optional<SteadyTime>& ended = courses_[i].ended;
    return ends_some && (!ended || now <= *ended + kAfterwards) && aimed(schedule_[i]);
  });
}

double SoakWatch::HighestStepP99_us(VehicleId vehicle) const {
  const auto view = views_.find(vehicle);
  return view == views_.end() ? 0 : view->second.step_p99_us;
}

const VehicleStatus* SoakWatch::StatusOf(VehicleId vehicle) const {
  const auto view = views_.find(vehicle);
  return view != views_.end() && view->second.status ? &*view->second.status : nullptr;
}

SteadyTime SoakWatch::StatusAt(VehicleId vehicle) const {
  const auto view = views_.find(vehicle);
  return view != views_.end() ? view->second.status_at : SteadyTime{0};
}

std::optional<std::uint64_t> SoakWatch::HeapOf(VehicleId vehicle, SteadyTime now) const {
  const VehicleStatus* const status = StatusOf(vehicle);
  if (status == nullptr || now - StatusAt(vehicle) > kFresh) return std::nullopt;
  return status->heap_bytes;
}

const Truth* SoakWatch::TruthOf(VehicleId vehicle) const {
  const auto view = views_.find(vehicle);
  return view != views_.end() && view->second.truth ? &*view->second.truth : nullptr;
}

}  // namespace giveway::fleetctl
