// One vehicle with its ultrasonics in a small scene, for the tests of the tiers.
#pragma once

#include <span>
#include <vector>

#include "sim_world/sensors/sonar.h"

namespace giveway::sim {

inline constexpr Nanoseconds kTickPeriod{50'000'000};

inline RobotModel WithAllTransducers() {
  RobotModel profile = PioneerP3dx();
  for (SensorMount& mount : profile.sonar) mount.enabled = true;
  return profile;
}

inline SonarModel Model(SonarTier tier) {
  SonarModel model;
  model.tier = tier;
  return model;
}

inline SonarModel Faultless(SonarTier tier) {
  SonarModel model = Model(tier);
  model.noise = 0;
  model.drop_out = 0;
  return model;
}

// One vehicle at the origin, looking along x, and what stands round it.
class OneVehicle {
 public:
  explicit OneVehicle(const SonarModel& model, std::span<const Wall> walls = {},
                      std::uint32_t id = 1, Nanoseconds tick_period = kTickPeriod)
      : scene(walls), id_(id), sonar_(model, 9, tick_period) {}

  const Readings& Sense(std::uint32_t tick) {
    const SonarSubject subject = {VehicleId{id_}, 0, pose, &ring_, &state_};
    sonar_.Sense(Tick{tick}, [&](double before_s) {
      asked_s.push_back(before_s);
      return SonarInstant{&scene, {&subject, 1}};
    });
    return state_.readings;
  }

  Scene scene;
  Pose pose;
  std::vector<double> asked_s;

 private:
  std::uint32_t id_;
  SonarRing ring_{WithAllTransducers()};
  SonarState state_;
  Sonar sonar_;
};

inline void AddDiscAhead(Scene* scene, double range_m) {
  scene->AddDisc({0.166 + range_m + 0.25, 0.027}, 0.25, 1);  // straight before transducer 3's apex
  scene->Index();
}

}  // namespace giveway::sim
