// Admits vehicles to a running world: keeps join requests until a slot is free for them, puts
// bodies into the run and removes them, and decides what each session is sent. A vehicle continues
// only from where the world says that its body stands.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"
#include "sim_world/run/roster.h"
#include "sim_world/run/run.h"

namespace giveway::sim {

class Admission {
 public:
  // Most sessions that wait at a time; further requests are ignored until repeated. Bounds the work
  // of a tick.
  static constexpr std::size_t kMostWaiting = 64;

  // `run` outlives this object.
  Admission(const Scenario& scenario, WorldEpoch epoch, Run* run);

  // Joins, or leaves. A waiting session repeats its request: one that does not is forgotten.
  void Take(const JoinRequest& request);
  // Once a tick, after the run's Advance: frees the slots of bodies that were removed.
  void FollowRun();
  // Vehicles whose bodies were removed since the last call: nothing else is sent to them any more,
  // except what Answer returns after it.
  std::vector<VehicleId> TakeGone();
  // What there is to send since the last call, in this order. Before the run's Advance.
  std::vector<RosterEntry> Answer();
  // Every admitted vehicle is informed again, with the run's present state and this reason.
  std::vector<RosterEntry> InformAll(const std::string& reason);

  // The sessions that know they are admitted, in this epoch.
  const std::map<VehicleId, RosterEntry>& Informed() const { return informed_; }
  // Requests that found the waiting list full.
  std::uint32_t PassedOver() const { return passed_over_; }
  // Slots in use, whether informed or not: after Restore none is.
  std::vector<VehicleId> Expected() const;

  FleetCheckpoint Save(std::uint64_t scenario) const;
  // False if it is not of this scenario; then neither this nor its run can be used any more.
  bool Restore(const FleetCheckpoint& checkpoint);

 private:
  // A session that still waits.
  struct Waiting {
    JoinRequest request;
    Tick since = kNoTick;
    Tick asked = kNoTick;     // last
    std::string last_reason;  // the last reason it was sent
  };
  // The result of a request in this tick; nothing if there is nothing to send.
  struct Result {
    bool waits = false;
    std::optional<RosterEntry> answer;
  };

  Result Try(Waiting* waiting);
  void LetIn(RosterEntry entry);
  bool MayTakeOver(VehicleId vehicle) const;
  bool IsFree(const VehicleOptions& options) const;
  void Leave(const SessionId& session);

  Run& run_;
  bool open_;
  std::uint32_t patience_ticks_;
  Roster roster_;
  std::vector<Waiting> waiting_;  // in order of asking
  std::map<VehicleId, RosterEntry> informed_;
  std::vector<VehicleId> gone_;
  std::vector<RosterEntry> answers_;
  std::uint32_t passed_over_ = 0;
};

}  // namespace giveway::sim
