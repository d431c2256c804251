#include "services/vehicle/mover_watch.h"

#include <chrono>

#include "services/types/time.h"
#include "services/vehicle/situation/echoes.h"

namespace giveway {
namespace {

// Turning faster than this, and so long after it, echoes do not show which of both moves.
constexpr double kSharpTurn_rad_s = 0.25;
constexpr Nanoseconds kTurnEcho = std::chrono::milliseconds(300);
// How long a vehicle stands after the last unidentified motion; by id, so that two of them do not
// start at the same time. With what it takes to notice the motion and to report, less than the five
// seconds in which a fleet drives again after its last fault.
constexpr double kUnidentifiedHold_s = 1.0;
constexpr double kUnidentifiedStagger_s = 0.5;
constexpr std::uint32_t kUnidentifiedStaggerSteps = 6;

}  // namespace

bool NoteTurning(const Twist& own, Tick tick, Nanoseconds tick_period, MoverWatch* watch) {
  // On the spot a slow turn is enough: nothing comes nearer by driving, and the rim of a cone leaps
  // along a wall by more than the turn explains.
  const bool on_the_spot = Magnitude(own.forward_m_s) < kStandingSpeed_m_s;
  const double sharp_rad_s = on_the_spot ? kTurning_rad_s : kSharpTurn_rad_s;
  if (Magnitude(own.turn_rad_s) > sharp_rad_s) watch->turned_tick = tick;
  return watch->turned_tick != kNoTick &&
         TicksBetween(watch->turned_tick, tick) <= TicksCovering(kTurnEcho, tick_period);
}

Movers DetectMovers(const OwnView& s, const PeersNow& near, MoverWatch* watch,
                    TrustCounters* counters) {
  bool moving = false;
  const double near_m = watch->unidentified ? s.options.gate_exit_m : s.options.gate_enter_m;
  for (const std::size_t i : BitsOf(s.turns ? 0 : s.ranges.Echoes() & ~near.explained)) {
    if (s.ranges[i].range_m >= near_m || !MovesByItself(i, s)) continue;
    moving = true;
    watch->unidentified_sensor = static_cast<int>(i);
  }
  if (moving) {
    counters->echo_without_beacon += watch->unidentified ? 0 : 1;
    watch->unidentified = true;
    watch->unidentified_since = s.now;
  }
  const double hold_s = kUnidentifiedHold_s +
                        kUnidentifiedStagger_s * (Number(s.options.id) % kUnidentifiedStaggerSteps);
  if (watch->unidentified && Seconds(s.now - watch->unidentified_since) > hold_s)
    watch->unidentified = false;
  return {.unidentified = watch->unidentified,
          .unidentified_sensor = watch->unidentified ? watch->unidentified_sensor : -1};
}

}  // namespace giveway
