// World and brains in memory for what the virtual fleet does not support yet: traffic lights, tiers
// of ultrasonics above ideal, and radar, lidar and camera.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "services/types/fleet_facts.h"
#include "services/vehicle/vehicle.h"
#include "sim_world/run/run.h"
#include "sim_world/run/traffic_lights.h"
#include "sim_world/sensors/sensor.h"
#include "sim_world/sensors/sonar.h"

namespace giveway::test {

class SmallFleet {
 public:
  explicit SmallFleet(const Scenario& scenario)
      : scenario_(scenario),
        run_(scenario_, WorldEpoch{1}),
        heads_(scenario_),
        sonar_(scenario_.sonar, scenario_.seed, scenario_.tick_period),
        scene_(scenario_.walls),
        sonar_states_(scenario_.vehicles.size()),
        outputs_(scenario_.vehicles.size()) {
    std::uint32_t boot_epoch = 1;
    for (const VehicleOptions& options : scenario_.vehicles) {
      run_.Join(options.id);
      brains_.push_back(std::make_unique<Vehicle>(options, boot_epoch++));
    }
    run_.Start();
  }

  // One tick; false once the run has ended.
  bool Advance() {
    run_.Advance(commands_);
    for (const WorldEvent& event : run_.Events()) history_.push_back(event);
    heads_.Advance(run_.TimeSeconds(), WorldEpoch{1}, run_.Now());
    Hear();
    std::vector<ReceivedBeacon> on_air;
    for (const Outputs& outputs : outputs_) {
      if (outputs.beacon.seq == 0) continue;
      Beacon beacon = outputs.beacon;
      if (lie_) lie_(&beacon);
      on_air.push_back({.beacon = beacon,
                        .received = Now(),
                        .crc_valid = true,
                        .name_valid = true,
                        .writer = outputs.beacon.boot_epoch});
    }
    commands_.clear();
    for (std::size_t i = 0; i < brains_.size(); ++i) Think(i, on_air);
    return run_.State() != RunState::kEnded;
  }

  // Changes what is received of a vehicle against what it sent; its own brain is unaffected.
  void Lie(std::function<void(Beacon*)> lie) { lie_ = std::move(lie); }

  sim::SignalHeads& Heads() { return heads_; }
  const sim::Run& World() const { return run_; }
  const Outputs& OutputsOf(std::size_t i) const { return outputs_[i]; }
  const Vehicle& Brain(std::size_t i) const { return *brains_[i]; }
  const std::vector<WorldEvent>& History() const { return history_; }
  std::uint32_t Count(EventKind kind) const {
    return static_cast<std::uint32_t>(
        std::count_if(history_.begin(), history_.end(),
                      [kind](const WorldEvent& event) { return event.kind == kind; }));
  }

 private:
  SteadyTime Now() const { return Number(run_.Now()) * scenario_.tick_period; }

  const sim::Scene& SceneBefore(double before_s) {
    scene_.Clear();
    subjects_.clear();
    for (std::size_t i = 0; i < brains_.size(); ++i) {
      const VehicleOptions& options = scenario_.vehicles[i];
      const Twist twist = TwistFromWheels(options.profile.drive, run_.Scans()[i].wheels);
      const Pose pose = AdvanceArc(run_.Truths()[i].world_from_body, twist, -before_s);
      scene_.AddDisc(pose.position_world, options.profile.body_radius_m,
                     static_cast<sim::Owner>(i));
      subjects_.push_back({.vehicle = options.id,
                           .owner = static_cast<sim::Owner>(i),
                           .world_from_body = pose,
                           .ring = &rings_.Of(options.profile),
                           .state = &sonar_states_[i]});
    }
    scene_.Index();
    return scene_;
  }

  void Hear() {
    sonar_.Sense(run_.Now(), [this](double before_s) {
      return sim::SonarInstant{&SceneBefore(before_s), subjects_};
    });
    SceneBefore(0);
    facts_.clear();
    for (std::size_t i = 0; i < brains_.size(); ++i) {
      facts_.push_back({.velocity_world = Velocity(i), .seen_class = SeenClass::kVehicle});
    }
  }

  Vec2 Velocity(std::size_t i) const {
    return run_.Truths()[i].forward_m_s * Forward(run_.Truths()[i].world_from_body);
  }

  void Think(std::size_t i, const std::vector<ReceivedBeacon>& on_air) {
    std::vector<ReceivedBeacon> heard;
    for (const ReceivedBeacon& beacon : on_air) {
      if (beacon.beacon.vehicle != scenario_.vehicles[i].id) heard.push_back(beacon);
    }
    Inputs inputs;
    inputs.now = Now();
    inputs.scan = run_.Scans()[i];
    inputs.scan->readings = sonar_states_[i].readings;
    inputs.beacons = heard;
    inputs.signals = heads_.States();
    const sim::SensorView view{.scene = scene_,
                               .facts = facts_,
                               .self = static_cast<sim::Owner>(i),
                               .world_from_body = run_.Truths()[i].world_from_body,
                               .velocity_world = Velocity(i),
                               .vehicle = scenario_.vehicles[i].id,
                               .epoch = WorldEpoch{1},
                               .tick = run_.Now()};
    const RobotModel& profile = scenario_.vehicles[i].profile;
    RadarScan radar;
    LidarScan lidar;
    CameraScan camera;
    if (profile.radar) inputs.radar = &(radar = SenseRadar(view));
    if (profile.lidar) inputs.lidar = &(lidar = SenseLidar(view));
    if (profile.camera) inputs.camera = &(camera = SenseCamera(view));
    outputs_[i] = brains_[i]->Step(inputs);
    commands_.push_back(outputs_[i].command);
  }

  Scenario scenario_;
  sim::Run run_;
  sim::SignalHeads heads_;
  sim::Sonar sonar_;
  sim::Scene scene_;
  sim::SonarRings rings_;
  std::vector<sim::SonarState> sonar_states_;
  std::vector<sim::SonarSubject> subjects_;
  std::vector<sim::OwnerFacts> facts_;
  std::vector<std::unique_ptr<Vehicle>> brains_;
  std::vector<Outputs> outputs_;
  std::vector<MotorCommand> commands_;
  std::vector<WorldEvent> history_;
  std::function<void(Beacon*)> lie_;
};

}  // namespace giveway::test
