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
  MoverWatch& movers = state_->movers;
  if (s->turn_rad_s > kSharpTurn_rad_s || s->turn_rad_s < -kSharpTurn_rad_s) {
    movers.turned_tick = s->tick;
  }
  s->turns =
      movers.turned_tick != kNoTick && TicksBetween(movers.turned_tick, s->tick) <= kTurnEchoTicks;
}

void Vehicle::ListenForMovers(Situation* s) {
  MoverWatch& movers = state_->movers;
  bool moving = false;
  const double near_m = movers.deaf ? options_.gate_exit_m : options_.gate_enter_m;
  for (const std::size_t i : BitsOf(s->turns ? 0 : s->ranges.Echoes() & ~s->explained)) {
    if (s->ranges[i].range_m >= near_m || !MovesByItself(i, *s)) continue;
    moving = true;
    movers.deaf_sensor = static_cast<int>(i);
  }
  if (moving) {
    state_->counters.trust.echo_without_beacon += movers.deaf ? 0 : 1;
    movers.deaf = true;
    movers.deaf_since = s->now;
  }
  const double hold_s = kDeafHold_s + kDeafStagger_s * (Number(options_.id) % kDeafStaggerSteps);
  if (movers.deaf && Seconds(s->now - movers.deaf_since) > hold_s) movers.deaf = false;
  s->deaf = movers.deaf;
  s->deaf_sensor = movers.deaf ? movers.deaf_sensor : -1;
}

}  // namespace giveway
