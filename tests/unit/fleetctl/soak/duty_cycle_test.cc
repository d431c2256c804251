// A process that gets a share of the time gets that share.
#include "services/fleetctl/soak/host_faults/duty_cycle.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// The share of ten seconds for which it runs, looked at every `turn`, each third look late.
double RunsFor(double share, milliseconds turn, milliseconds late) {
  SteadyTime now{0};
  DutyCycle duty(share, now);
  Nanoseconds ran{0};
  bool stopped = false;
  for (int look = 0; now < SteadyTime(seconds(10)); ++look) {
    const SteadyTime before = now;
    now += turn + (look % 3 == 0 ? late : milliseconds(0));
    if (!stopped) ran += now - before;
    stopped = duty.IsStoppedFrom(now);
  }
  return Seconds(ran) / Seconds(now - SteadyTime{0});
}

TEST(DutyCycle, AnyShareIsWhatItRunsFor) {
  for (const double share : {0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 0.8, 0.95}) {
    EXPECT_NEAR(RunsFor(share, milliseconds(50), milliseconds(0)), share, 0.02) << share;
    EXPECT_NEAR(RunsFor(share, milliseconds(50), milliseconds(37)), share, 0.03) << share;
  }
}

}  // namespace
}  // namespace giveway::fleetctl
