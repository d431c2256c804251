// The vocabulary of decisions: how far down the ladder a vehicle is, and which rule won.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "services/types/ids.h"

namespace giveway {

enum class Behaviour : std::uint8_t {
  kCooperative,
  kLectureAvoid,
  kStockAvoid,
  kLectureYield,
  kLecturePrinted,  // the yielding scripts with their flaws: collides, never a default
};
inline constexpr std::size_t kBehaviourCount = 5;

// The ladder. A vehicle only goes down on less evidence, never up on less.
enum class Mode : std::uint8_t {
  kCooperative,  // beacons and ranges are fresh
  kSensorOnly,   // a peer that matters is not heard or not believed: only the own ranges prove
  kHalt,         // ranges are stale: no motion
  kLeaving,      // the last beacons of a vehicle that stops in good order
};

// Why the wheels turn as they do. The most restrictive rule wins; its name goes into command,
// beacon, status and log.
enum class Rule : std::uint8_t {
  kCruise,              // nothing limits: drive to the goal
  kNotRunning,          // the world waits or has ended
  kArrived,             // the goal is reached
  kRangesStale,         // own ranges too old, missing, or of ultrasonics that do not work
  kGiveWay,             // the peer comes first in the order
  kNotGranted,          // first in the order, but the peer has not said that it gives way
  kPeerLost,            // a peer on a conflicting path fell silent
  kUnidentifiedMotion,  // something moves in critical distance and no fresh beacon explains it
  kObstacle,            // something stands in the own path
  kSteerRound,          // turning past a halted peer that gives way
  kAvoid,               // Braitenberg weights steer away
  kSignal,              // a fresh traffic light on the own path says stop
  kKeepClear,           // no further than where a peer cannot be, whatever it does
  kMakeRoom,            // of older vehicles: turning aside for one that comes first and cannot pass
  kObject,              // radar or lidar: an object whose place and motion make it an obstacle
  kLeaving,             // stopping in good order
  kUnsure,              // slower: soon it will not know any more where it is
  kLost,                // it does not know well enough where it is: it stands until a fix says so
};
inline constexpr Rule kLastRule = Rule::kLost;

// True for the rules by which a vehicle says that it will not move by itself.
constexpr bool StaysPut(Rule rule) {
  return rule == Rule::kArrived || rule == Rule::kNotRunning || rule == Rule::kLost;
}

// True for the rules that count as giving way to another vehicle (the verdict's `halted`).
constexpr bool IsGiveWay(Rule rule) {
  return rule == Rule::kGiveWay || rule == Rule::kNotGranted || rule == Rule::kPeerLost ||
         rule == Rule::kUnidentifiedMotion;
}

std::string_view Name(Behaviour behaviour);
std::string_view Name(Mode mode);
std::string_view Name(Rule rule);

// What the brain decided, and because of which peer or sensor.
struct Decision {
  Mode mode = Mode::kHalt;
  Rule rule = Rule::kNotRunning;
  VehicleId peer = kNoVehicle;  // kNoVehicle where no peer is the reason
  int sensor = -1;              // index of the deciding ultrasonic, -1 where none is
  // Tick of the scan or beacon that first showed the cause; kNoTick where time alone was the cause.
  Tick cause_tick = kNoTick;

  friend constexpr bool operator==(const Decision&, const Decision&) = default;
};

// True if both decisions say the same thing; the tick of the cause does not count.
constexpr bool SameReason(const Decision& a, const Decision& b) {
  return a.mode == b.mode && a.rule == b.rule && a.peer == b.peer;
}

}  // namespace giveway
