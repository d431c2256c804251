// A brain on a table: feed it scans and beacons tick by tick, read what it decides. No world.
#pragma once

#include <vector>

#include "services/types/math.h"
#include "services/vehicle/beacon_check.h"
#include "services/vehicle/vehicle.h"

namespace giveway::test {

inline constexpr WorldEpoch kEpoch{7};

inline VehicleOptions DefaultOptions(std::uint32_t id = 1) {
  VehicleOptions options;
  options.id = VehicleId{id};
  options.profile = PioneerP3dx();
  options.cruise_m_s = 0.3;
  options.goal = {.set = true, .at_world = {10, 0}};
  return options;
}

// All enabled sensors clear, rear ones without data.
inline RangeScan ClearScan(std::uint32_t tick) {
  RangeScan scan{.vehicle = VehicleId{1},
                 .epoch = kEpoch,
                 .tick = Tick{tick},
                 .run_state = RunState::kRunning};
  for (std::size_t i = 0; i < 8; ++i) scan.readings[i] = {Echo::kClear, 0, Tick{tick}};
  return scan;
}

inline void SetEcho(RangeScan* scan, int sensor, double range_m) {
  scan->readings[static_cast<std::size_t>(sensor)] = {Echo::kEcho, range_m, scan->tick};
}

// A believable beacon of vehicle `id` standing at `pose`, answering `tick`.
inline Beacon BeaconOf(std::uint32_t id, std::uint32_t tick, const Pose& pose,
                       double cruise_m_s = 0.3) {
  Beacon beacon;
  beacon.vehicle = VehicleId{id};
  beacon.boot_epoch = 100 + id;
  beacon.seq = tick;
  beacon.world_epoch = kEpoch;
  beacon.tick = Tick{tick};
  beacon.cruise_m_s = cruise_m_s;
  beacon.world_from_body = pose;
  beacon.toward_world = pose.position_world + 100.0 * Forward(pose);
  beacon.mode = Mode::kCooperative;
  beacon.rule = Rule::kCruise;
  beacon.order = {.speed_bucket = SpeedBucket(cruise_m_s), .vehicle = VehicleId{id}};
  return beacon;
}

inline ReceivedBeacon Received(const Beacon& beacon, SteadyTime at) {
  return {.beacon = beacon,
          .received = at,
          .crc_valid = true,
          .name_valid = true,
          .writer = 1000 + Number(beacon.vehicle)};
}

// Runs one brain through ticks 1, 2, 3 … of 50 ms.
class BrainBench {
 public:
  explicit BrainBench(const VehicleOptions& options) : options_(options), vehicle_(options, 42) {}

  std::uint32_t NextTick() const { return tick_ + 1; }
  SteadyTime Now() const { return tick_ * options_.tick_period; }
  const Vehicle& Brain() const { return vehicle_; }

  // One tick with this scan (its tick is set here) and these beacons.
  Outputs Step(RangeScan scan, const std::vector<Beacon>& beacons = {},
               const std::vector<QosEvent>& events = {}) {
    ++tick_;
    scan.tick = Tick{tick_};
    for (RangeReading& reading : scan.readings) reading.tick = scan.tick;
    return StepWith(scan, beacons, events);
  }
  // One tick's time passes and no scan comes.
  Outputs StepBlind() {
    ++tick_;
    return StepWith(std::nullopt, {}, {});
  }

 private:
  Outputs StepWith(std::optional<RangeScan> scan, const std::vector<Beacon>& beacons,
                   const std::vector<QosEvent>& events) {
    std::vector<ReceivedBeacon> received;
    for (const Beacon& beacon : beacons) received.push_back(Received(beacon, Now()));
    Inputs inputs;
    inputs.now = Now();
    inputs.scan = scan;
    inputs.beacons = received;
    inputs.events = events;
    return vehicle_.Step(inputs);
  }

  VehicleOptions options_;
  Vehicle vehicle_;
  std::uint32_t tick_ = 0;
};

}  // namespace giveway::test
