// What moves by itself near the vehicle, though no fresh beacon says who it is: critical but deaf.
#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/vehicle.h"

namespace giveway {
namespace {

// Turning faster than this, and for so many ticks after it, echoes say nothing about who moves.
constexpr double kSharpTurn_rad_s = 0.25;
constexpr std::uint32_t kTurnEchoTicks = 6;
// How long after the last unexplained motion a deaf vehicle stands; by id, so that two of them do
// not start as one.
constexpr double kDeafHold_s = 1.0;
constexpr double kDeafStagger_s = 0.5;
constexpr std::uint32_t kDeafStaggerSteps = 8;

}  // namespace

// A cone that swings along a wall makes its echo come nearer faster than any of the formulas say.
void Vehicle::NoteTurning(Situation* s) {
  VehicleState& state = *state_;
  if (s->turn_rad_s > kSharpTurn_rad_s || s->turn_rad_s < -kSharpTurn_rad_s) {
    state.turned_tick = s->tick;
  }
  s->turns =
      state.turned_tick != kNoTick && TicksBetween(state.turned_tick, s->tick) <= kTurnEchoTicks;
}

void Vehicle::ListenForMovers(Situation* s) {
  VehicleState& state = *state_;
  bool moving = false;
  const double near_m = state.deaf ? options_.gate_exit_m : options_.gate_enter_m;
  for (const std::size_t i : BitsOf(s->turns ? 0 : s->ranges.Echoes() & ~s->explained)) {
    if (s->ranges[i].range_m >= near_m || !MovesByItself(i, *s)) continue;
    moving = true;
    state.deaf_sensor = static_cast<int>(i);
  }
  if (moving) {
    state.trust.echo_without_beacon += state.deaf ? 0 : 1;
    state.deaf = true;
    state.deaf_since = s->now;
  }
  const double hold_s = kDeafHold_s + kDeafStagger_s * (Number(options_.id) % kDeafStaggerSteps);
  if (state.deaf && Seconds(s->now - state.deaf_since) > hold_s) state.deaf = false;
  s->deaf = state.deaf;
  s->deaf_sensor = state.deaf ? state.deaf_sensor : -1;
}

}  // namespace giveway
