#include "services/types/signal_plan.h"

#include <numeric>

#include "services/types/check.h"

namespace giveway {
namespace {

struct Cycle {
  explicit Cycle(const SignalPlan& plan)
      : green(FromSeconds(plan.green_s)),
        yellow(FromSeconds(plan.yellow_s)),
        whole(green + yellow + FromSeconds(plan.red_s)),
        offset(FromSeconds(plan.offset_s)) {
    GIVEWAY_CHECK(plan.green_s >= 0 && plan.yellow_s >= 0 && plan.red_s >= 0, Number(plan.id));
    GIVEWAY_CHECK(whole.count() > 0, Number(plan.id));
  }

  Nanoseconds green;
  Nanoseconds yellow;
  Nanoseconds whole;
  Nanoseconds offset;
};

// The remainder in [0, divisor).
Nanoseconds Modulo(Nanoseconds value, Nanoseconds divisor) {
  const Nanoseconds remainder = value % divisor;
  return remainder.count() < 0 ? remainder + divisor : remainder;
}

}  // namespace

PlannedPhase PhaseAt(const SignalPlan& plan, Nanoseconds since_start) {
  const Cycle cycle(plan);
  const Nanoseconds into = Modulo(since_start + cycle.offset, cycle.whole);
  if (into < cycle.green) return {SignalPhase::kGreen, cycle.green - into};
  const Nanoseconds open = cycle.green + cycle.yellow;
  if (into < open) return {SignalPhase::kYellow, open - into};
  return {SignalPhase::kRed, cycle.whole - into};
}

// How far b's opening lies after a's changes from cycle to cycle by multiples of both cycles, and
// takes every value that differs by a multiple of their greatest common divisor. So modulo that
// divisor one difference stands for all: they overlap if one opens while the other is open.
bool ShowGreenTogether(const SignalPlan& a, const SignalPlan& b) {
  const Cycle first(a);
  const Cycle second(b);
  const Nanoseconds common{std::gcd(first.whole.count(), second.whole.count())};
  const Nanoseconds first_open = first.green + first.yellow;
  const Nanoseconds second_open = second.green + second.yellow;
  if (first_open.count() == 0 || second_open.count() == 0) return false;
  return Modulo(first.offset - second.offset, common) < first_open ||
         Modulo(second.offset - first.offset, common) < second_open;
}

}  // namespace giveway
