// What the traffic lights say, by head: bounded, trivially copyable, and as fresh as the receiver's
// clock says. Answers one question: must this vehicle stop before a line, and how far away is that.
// A head that is dark, silent or not heard is as good as none: then right of way alone decides.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "services/types/signal.h"
#include "services/types/state_hash.h"
#include "services/types/time.h"
#include "services/vehicle/estimation/conflict.h"

namespace giveway {

inline constexpr std::size_t kMaxSignals = 32;  // the nearest, of all that a map has
// Three times the period at which heads speak: two in a row may be lost. A light is no beacon: what
// it said 300 ms ago still holds, for a plan changes by the second.
inline constexpr Nanoseconds kSignalAgeLimit{300'000'000};
// In about the same direction: within 45 degrees, of which this is the cosine.
inline constexpr double kCosSameWay = 0.7071067811865476;

// A straight part of a route.
struct Leg {
  Path path;
  double from_m = 0;  // where it starts, along the route from where the vehicle is
  double length_m = 0;
};

// Where a vehicle is and how it goes, as far as a stop line is concerned.
struct Approach {
  Path path;                      // towards the goal or the next waypoint, or straight on
  double distance_to_goal_m = 0;  // or to that waypoint
  double body_radius_m = 0;
  double stopping_m = 0;          // at normal deceleration, from what it drives now
  std::span<const Leg> beyond{};  // that waypoint, as far as a line there matters already
};

// A light that says stop.
struct StopLine {
  double free_m = 0;  // until the shell is as near to the line as it may come; may be negative
  SignalId signal = kNoSignal;
  Tick tick = kNoTick;  // of the state that says so
};

class SignalTable {
 public:
  // Keeps what the head publishes if it is of this world, plausible and newer. A full table gives
  // up a silent head, or else the one whose line is farthest from the vehicle, at `own_world`.
  // False if the state is refused, or no head is silent and none further away.
  bool Take(const SignalState& state, WorldEpoch epoch, SteadyTime now, Vec2 own_world);
  void LeaveWorld() { count_ = 0; }
  std::uint32_t Heard() const { return count_; }  // heads of this world, so far

  // The nearest line ahead at which a fresh head says stop: red; or yellow, if the vehicle could
  // still stop when it first saw it: that is decided once a yellow. A head matters if the path
  // crosses its line, before its end, within 45 degrees of the direction the head is for, and the
  // shell is not over the line yet.
  std::optional<StopLine> MustStopAt(const Approach& approach, SteadyTime now);

  void AddTo(StateHash* hash) const;

 private:
  friend struct StateFields;  // services/snapshot
  struct Head {
    SignalState state;
    SteadyTime heard{0};
    bool weighed = false;  // this yellow has been decided on
    bool clears = false;   // and the vehicle could not stop any more
  };
  std::span<Head> Heads() { return {heads_.data(), count_}; }
  Head* Find(SignalId id);
  Head* PlaceFor(const SignalState& state, SteadyTime now, Vec2 own_world);

  std::array<Head, kMaxSignals> heads_{};
  std::uint32_t count_ = 0;
};

}  // namespace giveway
