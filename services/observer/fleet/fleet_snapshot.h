// What an observer without prior knowledge knows of a fleet: folds what the link brings into the
// newest of each vehicle and of the world, and when each was last heard. Pure; the time is an
// argument.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "services/link/observer_link.h"
#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/time.h"

namespace giveway {

enum class Liveness : std::uint8_t {
  kNever,  // its body is in the world, and it says nothing
  kHeard,
  kSilent,  // nothing for kSilentAfter
  kLeft,    // its last status said that it leaves
};

// "heard", "silent", "left" or "not_heard".
std::string_view Name(Liveness liveness);

struct VehicleSnapshot {
  std::optional<VehicleStatus> status;  // the newest, and of the beacons
  std::optional<Beacon> beacon;
  std::optional<SteadyTime> status_at;
  std::optional<SteadyTime> beacon_at;
  bool has_body = false;  // in the world that is there now, as far as that was heard

  std::optional<SteadyTime> HeardAt() const;  // by either; nothing where never
  Liveness LivenessAt(SteadyTime now) const;
};

struct WorldSnapshot {
  // True if it published something within kSilentAfter, or is there and has nothing to publish.
  bool IsHeard(SteadyTime now) const;

  std::optional<SteadyTime> heard_at;
  bool is_empty = false;  // discovery has found it, and no body is in it
  WorldEpoch epoch = kNoEpoch;
  std::optional<RunState> state;  // nothing before a roster entry or an event
  double time_s = 0;              // since the start signal
  std::uint32_t fleet_size = 0;   // vehicles it waits for; 0 where not known
  std::optional<WorldEvent> last_event;
};

class FleetSnapshot {
 public:
  // A vehicle says something five times a second at least, and a running world twenty times.
  static constexpr SteadyTime kSilentAfter = std::chrono::seconds(1);

  // One that was silent for so long, and has no body in the world, is dropped: a process that was
  // restarted has another id, and would leave the old one silent for as long as the observer runs.
  // Long enough for an operator to be warned of it, and to see it among the others.
  static constexpr SteadyTime kDroppedAfter = std::chrono::minutes(5);

  // A process that claims ids without end takes no more; of more the one goes that was silent
  // longest.
  static constexpr std::size_t kMostVehicles = 4096;

  void Fold(const link::Observed& observed, SteadyTime now);

  const std::map<VehicleId, VehicleSnapshot>& Vehicles() const { return vehicles_; }
  const WorldSnapshot& World() const { return world_; }
  bool IsAnyHeard() const { return world_.heard_at.has_value() || !vehicles_.empty(); }
  // True once the whole fleet has been heard: no new vehicle came for a while, every body in the
  // world has sent something, and every vehicle published its status or had time to: a foreign one
  // has none.
  bool IsSettled(SteadyTime now) const;

 private:
  void MakeRoom();
  void DropGone(SteadyTime now);
  VehicleSnapshot& Known(VehicleId vehicle, SteadyTime now);
  void HearWorld(WorldEpoch epoch, SteadyTime now);
  void FoldTruth(const Truth& truth, SteadyTime now);
  void FindWorld(std::uint64_t participant);
  void FoldEvent(const WorldEvent& event, SteadyTime now);

  std::map<VehicleId, VehicleSnapshot> vehicles_;
  WorldSnapshot world_;
  std::uint64_t world_of_bodies_ = 0;  // the participant that was there when one was last heard of
  SteadyTime newcomer_at_{0};
};

}  // namespace giveway
