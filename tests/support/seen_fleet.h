// Two vehicles of a real run as an observer sees them, tick by tick.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "services/fleetctl/run/invariant_watch.h"

namespace giveway::fleetctl {

inline constexpr WorldEpoch kEpoch{5};
inline constexpr double kTick_s = 0.05;

// Both vehicles drive and nothing is wrong; a test says what is otherwise.
class SeenFleet : public testing::Test {
 protected:
  struct Car {
    Truth truth;
    Beacon beacon;
    VehicleStatus status;
    bool scans = true;  // it gets its scans, and answers them
    bool speaks = true;
    bool heard = true;  // by the observer
    bool seen = true;   // its truth reaches the observer
    bool status_comes = true;
  };

  SeenFleet() {
    scenario_.vehicles.resize(2);
    cars_.resize(2);
    for (std::uint32_t i = 0; i < 2; ++i) {
      const VehicleId id{i + 1};
      scenario_.vehicles[i].id = id;
      scenario_.vehicles[i].profile = PioneerP3dx();
      scenario_.vehicles[i].goal.set = true;
      Car& car = cars_[i];
      car.truth = {.vehicle = id, .epoch = kEpoch};
      car.beacon.vehicle = id;
      car.beacon.boot_epoch = 77 + i;
      car.beacon.world_epoch = kEpoch;
      car.beacon.order = {.speed_bucket = 10 - i, .vehicle = id};
      car.status = {.vehicle = id, .epoch = kEpoch};
      Drive(id, 0.3);
      Decide(id, Rule::kCruise);
    }
    scenario_.expect.arrived = {VehicleId{1}, VehicleId{2}};
    Begin();
  }

  void Begin() { watch_ = std::make_unique<InvariantWatch>(scenario_); }
  // The second vehicle is a newcomer of an open fleet.
  void BeginOpen() {
    scenario_.spawns.push_back(scenario_.vehicles[1]);
    scenario_.vehicles.pop_back();
    scenario_.expect.arrived.clear();
    Begin();
  }
  link::Observed TwoIsAccepted() const {
    link::Observed joined;
    joined.roster.push_back({.vehicle = two_, .accepted = true, .epoch = kEpoch, .spawn = 1});
    return joined;
  }
  Car& Of(VehicleId id) { return cars_[Number(id) - 1]; }
  void Drive(VehicleId id, double speed_m_s) {
    const double wheel = speed_m_s / DriveGeometry{}.wheel_radius_m;
    Of(id).truth.wheels = {wheel, wheel};
    Of(id).truth.forward_m_s = speed_m_s;
  }
  void Decide(VehicleId id, Rule rule, VehicleId peer = kNoVehicle) {
    Car& car = Of(id);
    car.status.decision = {.mode = Mode::kCooperative, .rule = rule, .peer = peer};
    car.beacon.mode = Mode::kCooperative;
    car.beacon.rule = rule;
    car.beacon.gives_way_to = rule == Rule::kGiveWay ? peer : kNoVehicle;
  }
  void Halt(VehicleId id, VehicleId peer) {
    Drive(id, 0);
    Decide(id, Rule::kGiveWay, peer);
  }

  // The world is restarted from its state that many ticks ago, and comes back under another epoch.
  void RestartWorld(std::uint32_t ticks_ago) {
    tick_ -= ticks_ago;
    epoch_ = WorldEpoch{Number(epoch_) + 1};
    for (Car& car : cars_) {
      car.truth.epoch = epoch_;
      car.beacon.world_epoch = epoch_;
      car.status.epoch = epoch_;
    }
  }

  void Observe(std::vector<WorldEvent> events = {}) {
    ++tick_;
    link::Observed observed;
    for (Car& car : cars_) {
      car.truth.tick = Tick{tick_};
      car.truth.time_s = tick_ * kTick_s;
      if (car.seen) observed.truths.push_back(car.truth);
      if (car.scans) car.status.tick = car.beacon.tick = Tick{tick_};
      car.beacon.seq += car.speaks ? 1 : 0;
      if (car.speaks && car.heard) {
        observed.beacons.push_back(
            {.beacon = car.beacon, .crc_valid = true, .name_valid = true, .writer = 1});
      }
      if (car.speaks && car.status_comes) observed.statuses.push_back(car.status);
    }
    for (WorldEvent& event : events) {
      event.epoch = epoch_;
      event.tick = Tick{tick_};
      observed.events.push_back(event);
    }
    watch_->Fold(observed);
  }
  void Observe(int ticks) {
    for (int i = 0; i < ticks; ++i) Observe();
  }
  std::uint32_t Count(sim::Invariant invariant) const { return watch_->Judged().Count(invariant); }
  bool Held() const { return watch_->Judged().Held(); }

  const VehicleId one_{1};
  const VehicleId two_{2};
  Scenario scenario_;
  std::vector<Car> cars_;
  std::unique_ptr<InvariantWatch> watch_;
  std::uint32_t tick_ = 0;
  WorldEpoch epoch_ = kEpoch;
};

}  // namespace giveway::fleetctl
