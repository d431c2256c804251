// How waiting moves a vehicle up in the order, and when it is forgotten.
#include "services/vehicle/estimation/planted.h"
#include "services/vehicle/vehicle.h"

namespace giveway {

// How long it has waited, by which it comes first: whole ageing limits only, so that this seldom
// changes, and two that wait for each other need not hear of every tick.
std::uint32_t Vehicle::AgedTicks() const {
  const auto limit = static_cast<std::uint32_t>(options_.ageing_limit / options_.tick_period);
  const std::uint32_t waited = state_->waiting.waited_ticks;
  return limit == 0 ? waited : waited / limit * limit;
}

// Its place in the order stands while encounters are under way. But once it has let somebody pass
// it rises all the same while it waits: in a stream of vehicles that come first they always are.
// What it waited is forgotten when it is through: away from where it stood, and meeting nobody.
void Vehicle::KeepOrder(const Situation& s, bool waits) {
  constexpr double kThrough_m = 2.5;
  Waiting& state = state_->waiting;
  const Vec2 position_world = s.world_from_body.position_world;
  state.let_pass = state.waited_ticks > 0 && (state.let_pass || s.let_pass);
  if (waits) {
    state.waited_ticks += s.new_tick ? 1 : 0;
    state.waited_world = position_world;
  } else if (!s.meets &&
             SquaredNorm(position_world - state.waited_world) > kThrough_m * kThrough_m) {
    state.waited_ticks = 0;
    state.let_pass = false;
  }
  if (Has(Defect::kWaitingNeverCounts)) return;
  if ((waits && state.let_pass) || !s.meets) state.order.waited_ticks = AgedTicks();
}

}  // namespace giveway
