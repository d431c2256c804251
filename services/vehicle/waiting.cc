#include "services/vehicle/waiting.h"

#include "services/vehicle/estimation/injected_mutants.h"

namespace giveway {

std::uint32_t AgedTicks(const Waiting& state, const VehicleOptions& options) {
  const auto limit = static_cast<std::uint32_t>(options.ageing_limit / options.tick_period);
  return limit == 0 ? state.waited_ticks : state.waited_ticks / limit * limit;
}

// Its key is frozen while encounters are active. But once it has let a peer pass, the key still
// rises while it waits: in a stream of vehicles with priority an encounter is always active. The
// waiting time is reset when it is through: away from where it stood, and without an encounter.
void KeepOrder(const OwnView& own, const Encounters& s, bool waits, Waiting* waiting) {
  constexpr double kThrough_m = 2.5;
  Waiting& state = *waiting;
  const Vec2 position_world = own.world_from_body.position_world;
  state.let_pass = state.waited_ticks > 0 && (state.let_pass || s.let_pass);
  if (waits) {
    state.waited_ticks += own.new_tick ? 1 : 0;
    state.waited_world = position_world;
  } else if (!s.meets &&
             SquaredNorm(position_world - state.waited_world) > kThrough_m * kThrough_m) {
    state.waited_ticks = 0;
    state.let_pass = false;
  }
  if (MutantActive(Mutant::kWaitingNeverCounts)) return;
  if ((waits && state.let_pass) || !s.meets) {
    state.order.waited_ticks = AgedTicks(state, own.options);
  }
}

}  // namespace giveway
