// Real time and real threads: the monitor sees that this process stood still.
#include "services/fleetctl/stopwatch/stall_monitor.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;

void Rest(Nanoseconds time) { SleepUntil(SteadyNow() + time); }

TEST(StallMonitor, APauseOfTheProcessIsSeenWhereItWasAndNowhereElse) {
  const StallMonitor monitor;
  Rest(milliseconds(120));
  const SteadyTime before = SteadyNow();
  const pid_t paused = ::getpid();
  const pid_t helper = ::fork();
  ASSERT_GE(helper, 0);
  if (helper == 0) {  // system calls only
    ::kill(paused, SIGSTOP);
    ::usleep(300'000);
    ::kill(paused, SIGCONT);
    ::_exit(0);
  }
  ASSERT_EQ(::waitpid(helper, nullptr, 0), helper);
  const SteadyTime after = SteadyNow();
  Rest(milliseconds(50));
  EXPECT_GE(monitor.LongestPause(before, after), milliseconds(290));
  EXPECT_LT(monitor.LongestPause(before - milliseconds(100), before - milliseconds(60)),
            milliseconds(290));
}

}  // namespace
}  // namespace giveway::fleetctl
