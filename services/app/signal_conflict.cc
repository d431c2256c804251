#include "services/app/signal_conflict.h"

#include <numeric>

namespace giveway::app {

// Head a goes in [i * A - offset, i * A - offset + go), head b likewise with its cycle B. How far a
// start of b lies behind one of a is the difference of the offsets plus any i * A + j * B, that is,
// plus any multiple of gcd(A, B). Both go at once if one of these falls in (-go of b, go of a).
bool GoTogether(const SignalPlan& a, const SignalPlan& b) {
  const auto whole = [](double seconds) { return FromSeconds(seconds).count(); };
  const auto go = [&](const SignalPlan& s) { return whole(s.green_s) + whole(s.yellow_s); };
  const auto cycle = [&](const SignalPlan& s) { return go(s) + whole(s.red_s); };
  const auto step = std::gcd(cycle(a), cycle(b));
  const auto behind = ((whole(a.offset_s) - whole(b.offset_s)) % step + step) % step;
  return behind < go(a) || step - behind < go(b);
}

}  // namespace giveway::app
