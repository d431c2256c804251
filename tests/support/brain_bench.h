// A brain on the bench: feed it scans and beacons tick by tick, read what it decides. No world.
#pragma once

#include <optional>
#include <vector>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/beacon_check.h"
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

// For peers that are near and never detected: switched off, the ultrasonics do not contradict them.
inline VehicleOptions OptionsWithoutUltrasonics() {
  VehicleOptions options = DefaultOptions();
  for (SensorMount& mount : options.profile.sonar) mount.enabled = false;
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

// The wheels of a Pioneer that drives straight on.
inline WheelSpeeds Rolling(double speed_m_s) {
  const double wheel_m = PioneerP3dx().drive.wheel_radius_m;
  return {speed_m_s / wheel_m, speed_m_s / wheel_m};
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

// What else comes with one tick; epoch and tick are set by the bench.
struct MoreInputs {
  std::vector<SignalState> signals;
  std::optional<RadarScan> radar;
  std::optional<LidarScan> lidar;
  std::optional<CameraScan> camera;
  std::optional<PoseFix> pose_fix;  // its tick is as the test says
};

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
  // The same with readings as old as they are: only those that changed have fired now.
  Outputs StepAsFired(RangeScan scan, const std::vector<Beacon>& beacons = {}) {
    ++tick_;
    scan.tick = Tick{tick_};
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      const bool repeated = tick_ > 1 && scan.readings[i].kind == readings_[i].kind &&
                            scan.readings[i].range_m == readings_[i].range_m;
      const bool clear = scan.readings[i].kind != Echo::kEcho;
      scan.readings[i].tick = repeated && !clear ? readings_[i].tick : scan.tick;
    }
    readings_ = scan.readings;
    return StepWith(scan, beacons, {});
  }
  const std::array<RangeReading, kSensorCount>& LastReadings() const { return readings_; }
  // What comes with the next step in addition to scan and beacons.
  MoreInputs& WithNext() { return more_; }
  // From now on the wheels turn at these speeds, until a scan says otherwise.
  void RollOn(WheelSpeeds wheels) { wheels_ = wheels; }
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
    // The wheels turn even if no scan reports it.
    if (scan) wheels_ = scan->wheels;
    counted_ = CountOn(counted_, wheels_, Seconds(options_.tick_period));
    if (scan) scan->counted = counted_;
    Inputs inputs;
    inputs.now = Now();
    inputs.scan = scan;
    inputs.beacons = received;
    inputs.events = events;
    inputs.signals = more_.signals;
    for (SignalState& signal : more_.signals) Stamp(&signal);
    if (more_.radar) inputs.radar = Stamp(&*more_.radar);
    if (more_.lidar) inputs.lidar = Stamp(&*more_.lidar);
    if (more_.camera) inputs.camera = Stamp(&*more_.camera);
    inputs.pose_fix = more_.pose_fix;
    const Outputs outputs = vehicle_.Step(inputs);
    more_ = {};
    return outputs;
  }

  template <typename Sample>
  const Sample* Stamp(Sample* sample) const {
    sample->epoch = kEpoch;
    sample->tick = Tick{tick_};
    return sample;
  }

  VehicleOptions options_;
  Vehicle vehicle_;
  MoreInputs more_;
  std::array<RangeReading, kSensorCount> readings_{};
  WheelSpeeds wheels_;
  WheelAngles counted_;
  std::uint32_t tick_ = 0;
};

}  // namespace giveway::test
