// The world: bodies that follow motor commands, walls, obstacles, doors, contacts and ultrasonics,
// tick by tick. It knows no brain, no clock and no run: it moves bodies while the caller lets it,
// and brakes them otherwise. The same commands in the same ticks give the same bits, in any order
// of joining and with any number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/types/parallel.h"
#include "services/types/scenario.h"
#include "services/types/state_hash.h"
#include "sim_world/active_contacts.h"
#include "sim_world/body.h"
#include "sim_world/checkpoint.h"
#include "sim_world/dynamics/collidables.h"
#include "sim_world/dynamics/contacts.h"
#include "sim_world/dynamics/doors.h"
#include "sim_world/dynamics/drive.h"
#include "sim_world/dynamics/obstacles.h"
#include "sim_world/geometry/neighbours.h"
#include "sim_world/sensing.h"
#include "sim_world/separation.h"

namespace giveway::sim {

// Every command taken is counted once.
struct CommandCounters {
  std::uint32_t accepted = 0;
  std::uint32_t wrong_epoch = 0;
  std::uint32_t unknown_vehicle = 0;
  std::uint32_t not_finite = 0;
  std::uint32_t out_of_order = 0;  // answers an older tick than one held, or a tick to come
};

class World {
 public:
  World(const Scenario& scenario, WorldEpoch epoch, ParallelFor parallel = OnThisThread);

  // Puts the body on its start pose, with wheels at rest and no command. The vehicle is known: one
  // of the scenario's, or one that has joined before, and not present.
  void Join(VehicleId vehicle);
  // The same for any vehicle, by options of its own; also during a run.
  void Join(const VehicleOptions& options);
  // Removes the body: it is no longer an obstacle.
  void Remove(VehicleId vehicle);
  // Forgets the vehicle, which is not present.
  void Forget(VehicleId vehicle);
  // Whether a vehicle could join by these options now: nothing else touches its start pose, nor
  // will before it can have braked for the newcomer, or be evaded.
  bool IsFree(const VehicleOptions& options) const;
  // Keeps the command until a newer one arrives. False: refused, and counted.
  bool Take(const MotorCommand& command);

  // The drive faults of the next ticks, by vehicle, until this is called again.
  void SetDriveFaults(std::span<const DriveFault> faults) {
    drive_faults_.assign(faults.begin(), faults.end());
  }
  // Makes the next tick. Bodies follow their commands if `driving`, else they brake. A body also
  // brakes when its command answers a tick more than the scenario's watchdog_ticks before this one.
  // Obstacles and doors move in driving ticks.
  void Advance(bool driving);

  Checkpoint Save() const;
  // Continues from there: vehicles in the checkpoint have joined, and are present unless they were
  // removed; others are not. Returns false, and changes nothing, if an unknown vehicle is present
  // in it or it is of another scenario.
  bool Restore(const Checkpoint& checkpoint);

  Tick Now() const { return now_; }
  // By id, joined or not.
  std::span<const Body> Bodies() const { return bodies_; }
  // Contacts that started in the last tick, in order of time.
  std::span<const Contact> NewContacts() const { return new_contacts_; }
  std::uint32_t Contacts() const { return contact_count_; }
  const Separation& Approaches() const { return separation_; }
  const CommandCounters& Commands() const { return commands_; }
  // Of the scenario's, in its order.
  std::span<const MovingObstacle> Obstacles() const { return obstacles_; }
  std::span<const SlidingDoor> Doors() const { return doors_; }

  // For auxiliary sensors: all shapes as they are after the last tick, and what may be known of the
  // owners of shapes: the index in Bodies(), then obstacles, then doors.
  const Scene& SceneNow() { return sensing_.SceneAtEnd(dt_s_, collidables_, bodies_); }
  OwnerFacts FactsOf(Owner owner) const;

  // Adds poses, wheels and their counts, contacts, obstacles and doors.
  void AddTo(StateHash* hash) const;

 private:
  Body* Find(VehicleId vehicle);
  const Body* Find(VehicleId vehicle) const;
  void Insert(const VehicleOptions& options);
  void Appear(Body* body);
  SonarTick SonarTickOf(bool driving) const;
  void Plan(bool driving);
  void PlanBody(bool driving, std::size_t i);
  const DriveFault* FaultOf(VehicleId vehicle) const;
  void PlanOthers(bool driving);
  std::span<const NearPair> FindPairs(bool driving);
  void FindFirstPairs(std::span<const Ball> of_bodies);
  void Note(const Hit& hit);
  void Settle();
  void SettleBody(std::size_t i);
  bool HasParted(const ContactPair& pair) const;
  std::uint32_t ThingOf(const Body& body) const;

  WorldEpoch epoch_;
  std::uint32_t seed_;
  double dt_s_;
  std::uint32_t watchdog_ticks_;
  ParallelFor parallel_;
  std::vector<Body> bodies_;  // sorted by id
  std::vector<MovingObstacle> obstacles_;
  std::vector<SlidingDoor> doors_;
  std::vector<DriveFault> drive_faults_;  // of the next tick, by vehicle
  Collidables collidables_;               // as the last tick moved them
  std::vector<Ball> balls_;
  Neighbours neighbours_;
  Neighbours body_neighbours_;  // of bodies alone, for their separation
  sim::Contacts contacts_;
  ActiveContacts active_contacts_;
  std::vector<Contact> new_contacts_;
  std::uint32_t contact_count_ = 0;
  Separation separation_;
  Sensing sensing_;
  CommandCounters commands_;
  Tick now_ = kNoTick;
  std::uint32_t driven_ticks_ = 0;  // since the start signal
  bool driving_ = false;            // in the last tick: obstacles move
};

}  // namespace giveway::sim
