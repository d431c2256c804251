// What a vehicle senses in one tick: its 16 ultrasonic readings and its wheel encoders. The world
// writes it, the brain reads it, and it is all a brain learns of the world.
#pragma once

#include <array>
#include <cstdint>

#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/robot_model.h"

namespace giveway {

// No echo is not no data: kClear says the sensor fired and nothing within its range answered.
enum class Echo : std::uint8_t { kNoData, kClear, kEcho };

struct RangeReading {
  Echo kind = Echo::kNoData;
  double range_m = 0;         // from the transducer to the nearest point in its cone; only if kEcho
  Tick tick = kNoTick;        // the first tick at or after the firing; readings keep their own age
  double fired_before_s = 0;  // the firing was this long before that tick; below a tick period
};

enum class RunState : std::uint8_t { kWaiting, kRunning, kEnded };

struct RangeScan {
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  RunState run_state = RunState::kWaiting;
  // Encoder rates: the constant wheel speeds that moved the body from the last tick to this one.
  WheelSpeeds wheels;
  // What the encoders have counted since the vehicle was put into the world: after missed scans it
  // says how far the vehicle came meanwhile.
  WheelAngles counted;
  std::array<RangeReading, kSensorCount> readings{};
};

}  // namespace giveway
