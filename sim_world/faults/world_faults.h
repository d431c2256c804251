// The faults of a schedule that the world injects: into ultrasonics, motors, encoders, pose fixes.
// Computes in each driving tick their effect on the wheels of each body, alters the scans that
// leave the world, and names the faults that start and end. The first and last tick of a fault
// depend only on its times, and every random number on seed, rule, the fault's number and the tick.
// Ignores the faults of other actors. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/types/pose_sensing.h"
#include "services/types/range_scan.h"
#include "services/types/time.h"
#include "sim_world/body.h"
#include "sim_world/dynamics/drive.h"
#include "sim_world/faults/sonar_fault.h"

namespace giveway::sim {

// The planned faults of a run, and the seed of all their draws.
struct FaultSchedule {
  faults::Schedule faults;
  std::uint64_t seed = 0;
};

// "sonar_stuck 3 of RULE": how an event of the run names a fault. The number counts from 0.
std::string EventText(const faults::Fault& fault);

class WorldFaults {
 public:
  WorldFaults(const FaultSchedule& schedule, Nanoseconds tick_period);

  // Starts the driving tick of that number, from 1 since the start signal.
  void BeginTick(std::uint32_t driven_tick, std::span<const Body> bodies);
  // The next tick is not a driving tick: no fault has an effect, and time stands still for the
  // active ones.
  void Rest();

  // The drive faults in this tick, by vehicle.
  std::span<const DriveFault> OfDrives() const { return drives_; }
  bool AlterScans() const { return !resting_ && sonars_ > 0; }
  // Applies this tick's faults to the scan of a body that is present.
  void Alter(const RobotModel& profile, RangeScan* scan);
  bool AlterFixes() const { return !resting_ && fixes_ > 0; }
  // Applies them to a fix. False: the fix is lost.
  bool Alter(PoseFix* fix) const;

  // Faults that started or ended in this tick. A fault starts in the first tick of its time in
  // which a body it concerns was present; only such a fault ends.
  std::span<const faults::Fault* const> Begun() const { return begun_; }
  std::span<const faults::Fault* const> Ended() const { return ended_; }

  // What a checkpoint keeps of an active fault. Previous ultrasonic readings are not part of it: in
  // a restarted world stuck sensors stick to their first reading, and delayed ones start their
  // delay again.
  struct HeldWheels {
    VehicleId vehicle = kNoVehicle;
    WheelSpeeds wheels;
  };
  struct State {
    std::uint32_t fault = 0;  // its place among the world's faults of the schedule
    bool begun = false;
    std::vector<HeldWheels> held;  // of kMotorStuck
  };
  std::vector<State> Save() const;
  // Continues after that driving tick. Returns false, and changes nothing, if such faults cannot
  // have been active then.
  bool Restore(std::span<const State> states, std::uint32_t driven_tick);

 private:
  // The state of a fault for one body.
  struct Memory {
    VehicleId vehicle = kNoVehicle;
    WheelSpeeds wheels;               // of kMotorStuck, as it started
    std::optional<SonarFault> sonar;  // of kinds of ultrasonics
  };
  struct Planned {
    faults::Fault fault;
    std::uint32_t begins = 0;  // first driving tick
    std::uint32_t ends = 0;    // one past the last
    std::uint64_t draws = 0;
    bool of_sonar = false;
    bool of_fix = false;
  };
  struct Active {
    std::uint32_t planned = 0;  // index
    bool begun = false;
    std::vector<Memory> memories;  // by vehicle
  };

  Memory* Remember(Active* active, const Body& body);
  void FollowTime(std::uint32_t driven_tick);
  void Follow(const Body& body);

  Nanoseconds tick_period_;
  std::vector<Planned> planned_;  // by start
  std::size_t next_ = 0;          // of planned_, to start
  std::vector<Active> active_;
  bool resting_ = true;
  std::uint32_t driven_tick_ = 0;
  std::size_t sonars_ = 0;  // of the active ones
  std::size_t fixes_ = 0;   // the same
  std::vector<DriveFault> drives_;
  std::vector<const faults::Fault*> begun_;
  std::vector<const faults::Fault*> ended_;
};

}  // namespace giveway::sim
