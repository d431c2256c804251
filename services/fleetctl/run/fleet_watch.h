// An observer's view of a run: folds what the link delivers into each vehicle's newest status, its
// track, the events and the figures, and builds the report from them. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/link/observer_link.h"
#include "services/report/picture.h"
#include "services/report/report.h"
#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// A verdict that is not the world's: an interrupt, a death, a start that failed.
struct Overruled {
  Verdict verdict = Verdict::kFailed;
  std::string reason;
};

class FleetWatch {
 public:
  // Tracks are kept only where a picture is drawn: they grow with the run.
  FleetWatch(const Scenario& scenario, bool keep_tracks);

  void Fold(const link::Observed& observed);
  // Vehicles whose planned kill has become due since the last call.
  std::vector<VehicleId> TakeDueKills();

  bool HasStarted() const { return started_; }
  bool HasEnded() const { return ended_; }
  bool HasFigures() const { return figures_.has_value(); }
  // Seconds since the start signal; 0 before it.
  double TimeSeconds() const { return time_s_; }
  const std::map<VehicleId, VehicleStatus>& Statuses() const { return statuses_; }
  // Every vehicle the scenario names, or in an open fleet the present ones.
  const std::set<VehicleId>& Vehicles() const { return vehicles_; }
  // Vehicles killed as planned, or no longer heard by the world.
  const std::set<VehicleId>& Silent() const { return silent_; }
  // True once every vehicle but those killed as planned has sent its last status; in an open fleet
  // those that fell silent are not waited for either.
  bool HasAllFinalStatuses() const;

  Report MakeReport(const std::optional<Overruled>& overruled) const;
  // With the verdict of this report in its header.
  std::string DrawPicture(const Report& report) const;
  // For the picture, of all vehicles.
  std::size_t KeptPoints() const;
  std::optional<Pose> LastPoint(VehicleId vehicle) const;

 private:
  void FoldEvent(const WorldEvent& event);
  void FoldStatus(const VehicleStatus& status);
  // Most points kept of one vehicle's track, however long the run: when it is full, every other
  // point is dropped and the sampling interval doubles.
  static constexpr std::size_t kMostPoints = 8192;
  static constexpr std::size_t kMostTracks = 1024;

  // One vehicle's track. Its last point is always the newest.
  struct KeptTrack {
    Track track;
    std::uint32_t stride = 1;  // one of so many points is kept
    std::uint32_t since = 0;   // the last one that was kept permanently
  };

  // What vehicles count of themselves. Each starts from 0 again with another process.
  struct Sums {
    std::uint64_t beacons_sent = 0;
    std::uint64_t beacons_received = 0;
    std::uint64_t deadline_missed = 0;
    std::uint64_t liveliness_lost = 0;
    TrustCounters trust;

    void Add(const VehicleStatus& status);
  };

  void FoldTruth(const Truth& truth);
  static void Keep(const Truth& truth, KeptTrack* kept);
  std::vector<VehicleId> VehiclesOf(EventKind kind) const;
  std::vector<VehicleId> Arrived() const;

  const Scenario& scenario_;
  bool open_;
  bool keep_tracks_;
  bool started_ = false;
  bool ended_ = false;
  double time_s_ = 0;
  std::set<VehicleId> vehicles_;
  std::map<VehicleId, VehicleStatus> statuses_;
  Sums ended_lives_;  // of vehicles that were started again
  std::map<VehicleId, KeptTrack> tracks_;
  std::vector<WorldEvent> events_;
  std::vector<VehicleId> due_kills_;
  std::vector<VehicleId> killed_;
  std::set<VehicleId> silent_;
  std::optional<RunFigures> figures_;
};

}  // namespace giveway::fleetctl
