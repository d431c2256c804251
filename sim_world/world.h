// The world: bodies that follow motor commands, walls, contacts and ultrasonics, tick by tick. It
// knows no brain, no clock and no run: it moves while it is told to, and brakes otherwise.
// The same commands in the same ticks give the same bits, whatever the order of joining.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "services/types/state_hash.h"
#include "sim_world/body.h"
#include "sim_world/motion.h"
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
  World(const Scenario& scenario, WorldEpoch epoch);

  // Puts the body on its start pose. The vehicle is one of the scenario's.
  void Join(VehicleId vehicle);
  // Takes the body away: it is no obstacle any more.
  void Remove(VehicleId vehicle);
  // Holds the command until a newer one comes. False: refused, and counted.
  bool Take(const MotorCommand& command);

  // Makes the next tick. Bodies follow their commands if `driving`, else they brake. A body also
  // brakes when its command answers a tick more than the scenario's watchdog_ticks before this one.
  void Advance(bool driving);

  Tick Now() const { return now_; }
  // In the order of the scenario, joined or not.
  std::span<const Body> Bodies() const { return bodies_; }
  // Contacts that began in the last tick.
  std::span<const Contact> NewContacts() const { return new_contacts_; }
  std::uint32_t Contacts() const { return contacts_; }
  const Separation& Approaches() const { return separation_; }
  const CommandCounters& Commands() const { return commands_; }
  // Adds poses, wheels and contacts.
  void AddTo(StateHash* hash) const;

 private:
  struct Hit {
    double t_s;
    std::size_t body;
    std::optional<std::size_t> other;  // a body, or none for a wall
    std::size_t wall;
  };

  Body* Find(VehicleId vehicle);
  void TurnWheels(bool driving);
  void StopAtContacts();
  std::optional<Hit> EarliestHit(double from_s) const;
  void EarliestBodyHit(std::size_t body, double from_s, std::optional<Hit>* earliest) const;
  void EarliestWallHit(std::size_t body, double from_s, std::optional<Hit>* earliest) const;
  void Stop(const Hit& hit);
  void Settle();
  void ReleaseContacts();
  void Sense();
  std::uint8_t& Touching(const Hit& hit);

  WorldEpoch epoch_;
  double dt_s_;
  std::uint32_t watchdog_ticks_;
  std::vector<Wall> walls_;
  std::vector<Pose> starts_world_;
  std::vector<SonarRing> rings_;
  std::vector<Body> bodies_;
  std::vector<Motion> motions_;  // of the tick being made
  std::vector<Disc> discs_;      // of the bodies present
  std::vector<std::uint8_t> touching_pairs_;
  std::vector<std::uint8_t> touching_walls_;  // [body * walls + wall]
  std::vector<Contact> new_contacts_;
  std::uint32_t contacts_ = 0;
  Separation separation_;
  CommandCounters commands_;
  Tick now_ = kNoTick;
};

}  // namespace giveway::sim
