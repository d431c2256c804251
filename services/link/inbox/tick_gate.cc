#include "services/link/inbox/tick_gate.h"

#include <algorithm>
#include <limits>

namespace giveway::link {

std::optional<Tick> TickGate::Latest(WorldEpoch epoch, SteadyTime now) const {
  if (epoch != epoch_ || now - passed_ > kForgets) return std::nullopt;
  const std::int64_t most = std::numeric_limits<std::uint32_t>::max();
  const std::int64_t gone = std::max<std::int64_t>(0, (now - since_) / least_period_);
  // A clock may run a hundredth faster than the other.
  const std::int64_t latest = std::int64_t{Number(first_)} + gone + gone / 100 + kAhead;
  return Tick{static_cast<std::uint32_t>(std::min(latest, most))};
}

bool TickGate::Passes(WorldEpoch epoch, Tick tick, SteadyTime now) {
  const std::optional<Tick> latest = Latest(epoch, now);
  if (latest && tick > *latest) return false;
  if (!latest) {
    epoch_ = epoch;
    first_ = tick;
    since_ = now;
  }
  passed_ = now;
  return true;
}

}  // namespace giveway::link
