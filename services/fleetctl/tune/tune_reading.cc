#include "services/fleetctl/tune/tune_reading.h"

#include <algorithm>
#include <variant>

#include "services/recording/recording_file.h"
#include "services/vehicle/vehicle.h"

namespace giveway::fleetctl {
namespace {

AlarmCause CauseOf(const Peer& peer) {
  if (peer.deadline_missed) return AlarmCause::kDeadline;
  return peer.liveliness_lost ? AlarmCause::kLiveliness : AlarmCause::kBeaconAge;
}

class Reader {
 public:
  Reader(const VehicleOptions& options, const AliveWindow& window, VehicleReading* reading)
      : options_(options), window_(window), reading_(*reading) {}

  void See(SteadyTime now, const VehicleState& state) {
    const bool counts = now >= window_.from && now <= window_.to;
    if (counts) NoteEvents(state.counters.qos);
    // To the end: a machine that pauses during a target's silence delays its detection.
    if (reading_.last_step > window_.from) {
      reading_.longest_pause = std::max(reading_.longest_pause, now - reading_.last_step);
    }
    reading_.last_step = now;
    for (const Peer& peer : state.heard.peers.Peers()) SeePeer(peer, now, state.world.tick, counts);
  }

 private:
  void NoteEvents(const QosCounters& qos) {
    if (!has_baseline_) baseline_ = qos;
    has_baseline_ = true;
    reading_.reported_deadline = qos.deadline_missed - baseline_.deadline_missed;
    reading_.reported_liveliness = qos.liveliness_lost - baseline_.liveliness_lost;
  }

  void SeePeer(const Peer& peer, SteadyTime now, Tick tick, bool counts) {
    if (!peer.known || peer.left || peer.out_of_reach) return;
    if (counts) NoteAge(TicksBetween(peer.beacon.tick, tick));
    const bool fresh = IsFresh(peer, now, tick, options_);
    const auto [known, is_new] = reading_.peers.try_emplace(peer.id);
    std::optional<Silenced>& silenced = known->second;
    if (fresh) {
      silenced.reset();
    } else if (!silenced && !is_new) {
      silenced = {now, CauseOf(peer)};
      if (counts) reading_.alarms.Add(silenced->cause);
    }
  }

  void NoteAge(std::uint32_t ticks) {
    constexpr std::uint32_t kMostTicks = 1000;
    ticks = std::min(ticks, kMostTicks);
    if (reading_.ages.size() <= ticks) reading_.ages.resize(ticks + 1);
    ++reading_.ages[ticks];
  }

  const VehicleOptions& options_;
  const AliveWindow window_;
  VehicleReading& reading_;
  bool has_baseline_ = false;
  QosCounters baseline_;  // at the window's first step
};

void FoldAges(const std::vector<VehicleReading>& readings, Nanoseconds tick,
              TrialEvidence* evidence) {
  std::vector<std::uint64_t> ages;
  std::uint64_t count = 0;
  double sum = 0;
  for (const VehicleReading& reading : readings) {
    ages.resize(std::max(ages.size(), reading.ages.size()));
    for (std::size_t ticks = 0; ticks < reading.ages.size(); ++ticks) {
      ages[ticks] += reading.ages[ticks];
      count += reading.ages[ticks];
      sum += static_cast<double>(reading.ages[ticks] * ticks);
    }
  }
  if (count == 0) return;
  evidence->age_mean_ms = sum / static_cast<double>(count) * Milliseconds(tick);
  std::uint64_t below = 0;
  std::size_t ticks = 0;
  while ((below += ages[ticks]) * 100 < count * 99) ++ticks;
  evidence->age_p99_ms = static_cast<double>(ticks) * Milliseconds(tick);
}

void FoldKilling(const std::vector<VehicleReading>& readings, const Killing& killing,
                 const std::vector<VehicleId>& dead, TrialEvidence* evidence) {
  const auto target = std::ranges::find(readings, killing.target, &VehicleReading::vehicle);
  if (target == readings.end()) return;
  for (const VehicleReading& reading : readings) {
    if (std::ranges::find(dead, reading.vehicle) != dead.end()) continue;
    const auto peer = reading.peers.find(killing.target);
    if (peer == reading.peers.end()) continue;
    if (!peer->second) {
      ++evidence->undetected;
    } else if (peer->second->at > killing.at) {
      evidence->detections.push_back({Milliseconds(peer->second->at - killing.at),
                                      Milliseconds(peer->second->at - target->last_step),
                                      peer->second->cause});
    }
  }
}

}  // namespace

VehicleReading ReadVehicle(std::istream* recording, const AliveWindow& window) {
  VehicleReading reading;
  RecordingFile file(recording);
  if (!file.Life()) {
    reading.trouble =
        file.Complaint().empty() ? "it is not the first part of a recording" : file.Complaint();
    return reading;
  }
  const VehicleOptions& options = file.Life()->options;
  reading.vehicle = options.id;
  Vehicle brain(options, file.Life()->boot_epoch);
  if (file.Life()->handover) brain.TakeOver(*file.Life()->handover);
  Reader reader(options, window, &reading);
  while (const std::optional<Record> record = file.Next()) {
    if (const auto* reseat = std::get_if<RecordedReseat>(&*record)) {
      brain.Reseat(reseat->options);
      continue;
    }
    const auto& step = std::get<RecordedStep>(*record);
    brain.Step(step.AsInputs());
    reader.See(step.now, brain.State());
  }
  reading.trouble = file.Complaint();
  return reading;
}

void FoldReadings(const std::vector<VehicleReading>& readings, const std::vector<Killing>& killings,
                  Nanoseconds tick, TrialEvidence* evidence) {
  for (const VehicleReading& reading : readings) {
    if (!reading.trouble.empty()) {
      evidence->trouble = "a recording cannot be read: " + reading.trouble;
    }
    evidence->alarms += reading.alarms;
    evidence->reported_deadline += reading.reported_deadline;
    evidence->reported_liveliness += reading.reported_liveliness;
    evidence->longest_pause_ms =
        std::max(evidence->longest_pause_ms, Milliseconds(reading.longest_pause));
  }
  FoldAges(readings, tick, evidence);
  std::vector<VehicleId> dead;
  for (const Killing& killing : killings) {
    dead.push_back(killing.target);
    FoldKilling(readings, killing, dead, evidence);
  }
}

}  // namespace giveway::fleetctl
