// What a traffic light says: its phase, and how long until it changes.
#pragma once

#include <cstdint>

#include "services/types/ids.h"
#include "services/types/math/vec2.h"

namespace giveway {

// Names one signal head. 0 is none.
enum class SignalId : std::uint32_t {};
inline constexpr SignalId kNoSignal{0};
constexpr std::uint32_t Number(SignalId id) { return static_cast<std::uint32_t>(id); }

enum class SignalPhase : std::uint8_t { kDark, kRed, kYellow, kGreen };

struct SignalState {
  SignalId id = kNoSignal;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  Vec2 line_from_world;  // the stop line; traffic crosses it in the direction of travel_rad
  Vec2 line_to_world;
  double travel_rad = 0;  // world frame, (-pi, pi]
  SignalPhase phase = SignalPhase::kDark;
  double to_change_s = 0;  // until the next phase; 0 while dark
};

}  // namespace giveway
