#include "services/fleetctl/run/fleet_watch.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <set>
#include <utility>

namespace giveway::fleetctl {
namespace {

std::string HashText(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

void AddFigures(const RunFigures& figures, Report* report) {
  report->verdict = figures.passed ? Verdict::kPassed : Verdict::kFailed;
  report->reason = figures.reason;
  report->contacts = figures.contacts;
  report->min_separation_m = figures.min_separation_m;
  report->time_to_clear_s = figures.time_to_clear_s;
  report->reaction_p50_ms = figures.reaction_p50_ms;
  report->reaction_p99_ms = figures.reaction_p99_ms;
  report->reaction_max_ms = figures.reaction_max_ms;
  report->tick_overruns = figures.tick_overruns;
  report->state_hash = HashText(figures.state_hash);
}

// Whether they are of two processes: only the first has counted further, or has said its last.
bool IsAnotherLife(const VehicleStatus& before, const VehicleStatus& now) {
  return now.beacons.sent < before.beacons.sent || (before.final && !now.final);
}

}  // namespace

FleetWatch::FleetWatch(const Scenario& scenario, bool keep_tracks)
    : scenario_(scenario), open_(!scenario.spawns.empty()), keep_tracks_(keep_tracks) {
  for (const VehicleOptions& vehicle : scenario.vehicles) vehicles_.insert(vehicle.id);
}

void FleetWatch::Fold(const link::Observed& observed) {
  for (const WorldEvent& event : observed.events) FoldEvent(event);
  for (const Truth& truth : observed.truths) FoldTruth(truth);
  for (const VehicleStatus& status : observed.statuses) FoldStatus(status);
  for (const RosterEntry& entry : observed.roster) {
    if (entry.run_state == RunState::kEnded) ended_ = true;
  }
  if (observed.figures) figures_ = observed.figures;
}

void FleetWatch::FoldEvent(const WorldEvent& event) {
  events_.push_back(event);
  time_s_ = std::max(time_s_, event.time_s);
  if (event.kind == EventKind::kStarted) started_ = true;
  if (event.kind == EventKind::kEnded) ended_ = true;
  if (event.kind == EventKind::kSilent) silent_.insert(event.vehicle);
  if (event.kind == EventKind::kJoined) {
    vehicles_.insert(event.vehicle);
    silent_.erase(event.vehicle);
  }
  if (open_ && (event.kind == EventKind::kLeft || event.kind == EventKind::kRemoved)) {
    vehicles_.erase(event.vehicle);
    silent_.erase(event.vehicle);
  }
  if (event.kind == EventKind::kFaultDue && event.vehicle != kNoVehicle) {
    due_kills_.push_back(event.vehicle);
    killed_.push_back(event.vehicle);
    silent_.insert(event.vehicle);
  }
}

void FleetWatch::Sums::Add(const VehicleStatus& status) {
  beacons_sent += status.beacons.sent;
  beacons_received += status.beacons.accepted;
  deadline_missed += status.qos.deadline_missed;
  liveliness_lost += status.qos.liveliness_lost;
  trust += status.trust;
}

// The last samples of a vehicle that left may arrive after the world's event.
void FleetWatch::FoldStatus(const VehicleStatus& status) {
  VehicleStatus& newest = statuses_[status.vehicle];
  if (IsAnotherLife(newest, status)) ended_lives_.Add(newest);
  newest = status;
  if (open_ && !status.final) vehicles_.insert(status.vehicle);
}

void FleetWatch::FoldTruth(const Truth& truth) {
  time_s_ = std::max(time_s_, truth.time_s);
  if (!keep_tracks_) return;
  const auto track = tracks_.find(truth.vehicle);
  if (track == tracks_.end() && tracks_.size() == kMostTracks) return;
  Keep(truth, &tracks_[truth.vehicle]);
}

void FleetWatch::Keep(const Truth& truth, KeptTrack* kept) {
  std::vector<Truth>& points = kept->track.truths;
  kept->track.vehicle = truth.vehicle;
  if (kept->since > 0) points.pop_back();  // it was kept only as the newest
  points.push_back(truth);
  kept->since = (kept->since + 1) % kept->stride;
  if (kept->since > 0 || points.size() < kMostPoints) return;
  std::size_t left = 0;
  for (std::size_t i = 1; i < points.size(); i += 2) points[left++] = points[i];
  points.resize(left);
  kept->stride *= 2;
}

std::size_t FleetWatch::KeptPoints() const {
  std::size_t points = 0;
  for (const auto& [vehicle, kept] : tracks_) points += kept.track.truths.size();
  return points;
}

std::optional<Pose> FleetWatch::LastPoint(VehicleId vehicle) const {
  const auto track = tracks_.find(vehicle);
  if (track == tracks_.end()) return std::nullopt;
  return track->second.track.truths.back().world_from_body;
}

std::vector<VehicleId> FleetWatch::TakeDueKills() { return std::exchange(due_kills_, {}); }

bool FleetWatch::HasAllFinalStatuses() const {
  return std::ranges::all_of(vehicles_, [this](VehicleId vehicle) {
    if (std::ranges::find(killed_, vehicle) != killed_.end()) return true;
    if (open_ && silent_.contains(vehicle)) return true;
    const auto status = statuses_.find(vehicle);
    return status != statuses_.end() && status->second.final;
  });
}

std::vector<VehicleId> FleetWatch::VehiclesOf(EventKind kind) const {
  std::set<VehicleId> vehicles;
  for (const WorldEvent& event : events_) {
    if (event.kind == kind) vehicles.insert(event.vehicle);
  }
  return {vehicles.begin(), vehicles.end()};
}

// Vehicles that stand in their goals, or did before they were put on a start pose again. In its
// goal a vehicle does not halt, so kResumed without a halt before means that it left the goal.
std::vector<VehicleId> FleetWatch::Arrived() const {
  std::set<VehicleId> arrived;
  std::set<VehicleId> in_goal;
  for (const WorldEvent& event : events_) {
    if (event.kind == EventKind::kArrived) {
      arrived.insert(event.vehicle);
      in_goal.insert(event.vehicle);
    } else if (event.kind == EventKind::kHalted) {
      in_goal.erase(event.vehicle);
    } else if (event.kind == EventKind::kResumed && in_goal.erase(event.vehicle) > 0) {
      arrived.erase(event.vehicle);
    }
  }
  return {arrived.begin(), arrived.end()};
}

Report FleetWatch::MakeReport(const std::optional<Overruled>& overruled) const {
  Report report;
  report.scenario = scenario_.name;
  report.seed = scenario_.seed;
  report.contacts = static_cast<std::uint32_t>(
      std::ranges::count(events_, EventKind::kContact, &WorldEvent::kind));
  report.halted = VehiclesOf(EventKind::kHalted);
  report.arrived = Arrived();
  Sums sums = ended_lives_;
  for (const auto& [vehicle, status] : statuses_) sums.Add(status);
  report.beacons_sent = sums.beacons_sent;
  report.beacons_received = sums.beacons_received;
  report.deadline_missed = sums.deadline_missed;
  report.liveliness_lost = sums.liveliness_lost;
  report.trust = sums.trust;
  if (figures_) AddFigures(*figures_, &report);
  if (overruled) {
    report.verdict = overruled->verdict;
    report.reason = overruled->reason;
  }
  return report;
}

std::string FleetWatch::DrawPicture(const Report& report) const {
  std::vector<Track> tracks;
  for (const auto& [vehicle, kept] : tracks_) tracks.push_back(kept.track);
  return DrawRun(scenario_, tracks, events_, Headline{report.verdict, report.reason});
}

}  // namespace giveway::fleetctl
