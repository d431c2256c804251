#include "services/vehicle_node/vehicle_report.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "services/link/fastdds/packets_of_process.h"

namespace giveway {
namespace {

constexpr std::size_t kKeptSteps = 1000;

struct Counted {
  const char* name;
  std::uint64_t number;
};

std::string Listed(std::string text, std::initializer_list<Counted> all) {
  for (const Counted& counted : all) {
    text += std::string(" ") + counted.name + '=' + std::to_string(counted.number);
  }
  return text;
}

}  // namespace

std::string Describe(const Decision& decision) {
  std::string text(Name(decision.rule));
  if (decision.peer != kNoVehicle) text += " for " + std::to_string(Number(decision.peer));
  if (decision.sensor >= 0) text += ", sensor " + std::to_string(decision.sensor + 1);
  return text + " (" + std::string(Name(decision.mode)) + ")";
}

std::string Describe(const QosEvent& event) {
  return std::string(Name(event.kind)) + ": " +
         (event.vehicle == kNoVehicle ? "a vehicle the library does not name"
                                      : "vehicle " + std::to_string(Number(event.vehicle)));
}

std::string Describe(const ReactionMargin& margin) {
  const auto centimetres = [](double metres) { return std::to_string(std::lround(metres * 100)); };
  return centimetres(margin.reaction_m) + " cm driven of " + centimetres(margin.free_m) +
         " cm free before the wheels obeyed";
}

std::string Describe(const ImpairmentCounters& counters) {
  return Listed("impairment:", {{"packets", counters.packets},
                                {"bytes", counters.bytes},
                                {"passed", counters.passed},
                                {"passed_bytes", counters.passed_bytes},
                                {"dropped_blackout", counters.dropped_blackout},
                                {"dropped_rate", counters.dropped_rate},
                                {"dropped_loss", counters.dropped_loss},
                                {"dropped_burst", counters.dropped_burst},
                                {"delayed", counters.delayed},
                                {"held_back", counters.held_back},
                                {"reordered", counters.reordered},
                                {"duplicated", counters.duplicated},
                                {"corrupted", counters.corrupted},
                                {"metered", counters.metered},
                                {"abandoned", counters.abandoned}});
}

std::string Describe(const link::VehicleLinkCounters& counters) {
  return Listed("link:", {{"ranges_skipped", counters.ranges_skipped},
                          {"ranges_deadline_missed", counters.ranges_deadline_missed},
                          {"sensors_deadline_missed", counters.sensors_deadline_missed},
                          {"signals_deadline_missed", counters.signals_deadline_missed},
                          {"unbound_samples", counters.refused.unbound_samples},
                          {"unreadable_samples", counters.refused.unreadable_samples},
                          {"wrong_name_scans", counters.refused.wrong_name_scans},
                          {"old_world_entries", counters.refused.old_world_entries},
                          {"strangers", counters.refused.strangers},
                          {"implausible", counters.refused.implausible},
                          {"events_dropped", counters.events_dropped},
                          {"deadline_watches_lost", counters.deadline_watches_lost},
                          {"write_failures", counters.write_failures}});
}

void VehicleReport::NoteStep(Nanoseconds step, Nanoseconds turn) {
  const double us = Milliseconds(step) * 1000;
  if (steps_us_.size() < kKeptSteps) {
    steps_us_.push_back(us);
  } else {
    steps_us_[next_] = us;
    next_ = (next_ + 1) % kKeptSteps;
  }
  longest_turn_ms_ = std::max(longest_turn_ms_, Milliseconds(turn));
}

void VehicleReport::NoteEvents(std::span<const QosEvent> events) {
  if (!events.empty()) last_event_ = events.back();
}

double VehicleReport::StepP99Us() {
  if (steps_us_.empty()) return 0;
  sorted_ = steps_us_;
  const auto rank = sorted_.begin() + static_cast<std::ptrdiff_t>((sorted_.size() * 99 - 1) / 100);
  std::nth_element(sorted_.begin(), rank, sorted_.end());
  return *rank;
}

VehicleStatus VehicleReport::Gather(const Vehicle& vehicle, const link::DriveLink& link) {
  const VehicleState& state = vehicle.State();
  const link::VehicleLinkCounters counters = link.Counters();
  const link::EffectiveBeaconQos qos = link.BeaconQos();
  VehicleStatus status;
  status.vehicle = state.waiting.order.vehicle;
  status.epoch = state.world.epoch;
  status.tick = state.world.tick;
  status.decision = state.last.decision;
  status.gives_way_to = state.published.gives_way_to;
  status.forward_m_s = vehicle.SpeedMps();
  const double nearest = state.sensed.ranges.NearestEcho();
  if (nearest >= 0) status.nearest_echo_m = nearest;
  status.peers_heard = vehicle.PeersHeard();
  status.beacons = state.counters.beacons;
  status.trust = state.counters.trust;
  status.beacons_superseded = counters.beacons_superseded;
  status.qos = state.counters.qos;
  status.last_deadline_missed = state.heard.peers.LastDeadlineMissed();
  status.last_liveliness_lost = state.heard.peers.LastLivelinessLost();
  if (last_event_) {
    status.last_event = last_event_->kind;
    status.last_event_about = last_event_->vehicle;
  }
  status.last_rejected_id = Number(state.heard.peers.LastRejected());
  status.step_p99_us = StepP99Us();
  status.loop_max_ms = longest_turn_ms_;
  status.beacon_deadline_offered_ms = qos.deadline_offered_ms;
  status.beacon_deadline_requested_ms = qos.deadline_requested_ms;
  status.beacon_lease_ms = qos.lease_ms;
  status.impaired = counters.impaired;
  status.timing = timing_.Figures();
  status.packets = link::PacketsOfProcess();
  status.refused = counters.refused;
  status.departed = ledger_.Departed();
  status.accounts = ledger_.NextRows();
  status.heap_bytes = heap_bytes_;
  return status;
}

void VehicleReport::AskForHeap(SteadyTime now) {
  if (now < next_heap_) return;
  next_heap_ = now + kHeapEvery;
  heap_bytes_ = heap_();
}

VehicleStatus VehicleReport::Send(const Vehicle& vehicle, link::DriveLink& link, SteadyTime now) {
  AskForHeap(now);
  const VehicleStatus status = Gather(vehicle, link);
  link.SendStatus(status);
  return status;
}

void VehicleReport::SendFinal(const Vehicle& vehicle, link::DriveLink& link) {
  VehicleStatus status = Gather(vehicle, link);
  status.final = true;
  link.SendStatus(status);
}

}  // namespace giveway
