// World and brains in one thread and in virtual time: the same Run and the same Vehicle::Step as in
// the real fleet, with a radio in memory between them. A beacon of tick k is heard at tick k + 1,
// as in a real run in which nothing is lost. Knows no clock and no middleware.
#pragma once

#include <memory>
#include <vector>

#include "services/types/scenario.h"
#include "services/vehicle/vehicle.h"
#include "sim_world/run.h"

namespace giveway::sim {

class VirtualFleet {
 public:
  // Everyone joins and the run starts at once.
  explicit VirtualFleet(const Scenario& scenario);

  // One tick for world and brains. False once the run has ended.
  bool Advance();
  // Advances until the run has ended.
  void Finish();

  const Run& World() const { return run_; }
  const Vehicle& Brain(std::size_t index) const { return *members_[index].brain; }
  // What the vehicle said in the last tick.
  const Outputs& Said(std::size_t index) const { return members_[index].said; }
  // Every event of the run so far.
  const std::vector<WorldEvent>& History() const { return history_; }

 private:
  struct Member {
    VehicleId id = kNobody;
    std::unique_ptr<Vehicle> brain;
    bool alive = true;
    Outputs said;
  };
  void Deliver();
  void Think();
  void CarryOutFaults();

  Scenario scenario_;
  Run run_;
  std::vector<Member> members_;         // in the scenario's order
  std::vector<ReceivedBeacon> on_air_;  // of the tick before
  std::vector<MotorCommand> commands_;
  std::vector<WorldEvent> history_;
};

}  // namespace giveway::sim
