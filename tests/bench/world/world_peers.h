// The peers the world's ultrasonics are measured against: general engines that cast seven rays a
// cone, at -15, -10, ... 15 degrees off its axis, over the same discs and walls, and keep the
// nearest hit. The own body is left out. They do less than the world: bodies are carried along the
// world's own motion, no contact is looked for and no wheel turned. Single precision, as both
// engines are.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "services/types/scenario.h"

namespace giveway::bench {

inline constexpr std::size_t kRaysACone = 7;
inline constexpr double kRayStep_rad = 0.08726646259971647;  // 5 degrees
inline constexpr float kNothingHit = 1e9F;

// Metres from each transducer to the nearest hit of its seven rays; kNothingHit where none hit.
using RayRanges = std::array<float, kSensorCount>;

class Peer {
 public:
  virtual ~Peer() = default;

  // Brings the bodies to these poses within one tick. Poses are in the scenario's order.
  virtual void Move(std::span<const Pose> world_from_body) = 0;
  // Casts all rays of all vehicles from the poses last moved to.
  virtual void Sense() = 0;
  // Of the last Sense, in the scenario's order.
  virtual std::span<const RayRanges> Ranges() const = 0;
};

// All vehicles of the scenario are discs, alike, with every transducer on.
std::unique_ptr<Peer> MakeBox2dPeer(const Scenario& scenario);
std::unique_ptr<Peer> MakeEmbreePeer(const Scenario& scenario);

// The rays of one vehicle in its body frame, cone by cone.
inline constexpr std::size_t kRaysAVehicle = kSensorCount * kRaysACone;
struct RayFan {
  std::array<float, kRaysAVehicle> origin_x_body{};
  std::array<float, kRaysAVehicle> origin_y_body{};
  std::array<float, kRaysAVehicle> direction_x_body{};  // unit vectors
  std::array<float, kRaysAVehicle> direction_y_body{};
  float range_m = 0;
};
RayFan FanOf(const RobotModel& profile);

}  // namespace giveway::bench
