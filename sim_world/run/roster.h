// Assigns places: one slot per vehicle id, with the session that has it. Answers join requests by
// the scenario's list of vehicles and, in an open fleet, by its spawn places. Knows no bodies: it
// asks the caller whether a place is free and whether a session is alive.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"

namespace giveway::sim {

// A fleet is open where the scenario has spawn places.
inline bool IsOpen(const Scenario& scenario) { return !scenario.spawns.empty(); }

struct Slot {
  VehicleId vehicle = kNoVehicle;
  std::uint32_t spawn = 0;  // as RosterEntry::spawn
  bool taken = false;
  SessionId session{};
};

// What must be known about the world to assign a slot.
struct SlotQuestions {
  // Whether the session with the vehicle's slot has fallen silent: then another may have it.
  std::function<bool(VehicleId)> is_silent = [](VehicleId) { return false; };
  // Whether a body could be put where these options start.
  std::function<bool(const VehicleOptions&)> is_free = [](const VehicleOptions&) { return true; };
};

class Roster {
 public:
  Roster(const Scenario& scenario, WorldEpoch epoch);

  // Accepted with id and start pose; or `waiting` with the reason, if a slot may still become free;
  // or refused permanently with a reason. A session that has a slot always gets the same answer,
  // whatever id it asks for. run_state is set by the caller.
  RosterEntry Admit(const JoinRequest& request, const SlotQuestions& ask = {});
  // Frees the vehicle's slot.
  void Free(VehicleId vehicle);

  // The slot of the session; null if it has none.
  const Slot* SlotOf(const SessionId& session) const;
  // The options with which the vehicle of a slot drives.
  VehicleOptions OptionsOf(const Slot& slot) const;

  // By id: the scenario's vehicles, taken or not, and those of other vehicles that are taken.
  std::span<const Slot> Slots() const { return slots_; }
  // Returns false, and changes nothing, if a slot is not of this scenario.
  bool Restore(std::span<const Slot> slots);

 private:
  bool IsNamed(VehicleId vehicle) const;
  bool IsFull() const;
  Slot* Find(VehicleId vehicle);
  RosterEntry AdmitAny(const JoinRequest& request, const SlotQuestions& ask);
  RosterEntry AdmitTo(Slot* slot, const JoinRequest& request, const SlotQuestions& ask);
  RosterEntry AdmitBySpawn(VehicleId vehicle, const JoinRequest& request, const SlotQuestions& ask);
  bool IsPatrolled(std::uint32_t spawn) const;
  VehicleId LowestFree() const;
  RosterEntry Accept(const Slot& slot) const;
  RosterEntry Refuse(const JoinRequest& request, std::string reason, bool waiting) const;

  WorldEpoch epoch_;
  bool open_;
  std::uint32_t fleet_size_;
  std::vector<VehicleOptions> named_;   // sorted by id
  std::vector<VehicleOptions> spawns_;  // without id
  std::vector<Slot> slots_;             // sorted by id
};

}  // namespace giveway::sim
