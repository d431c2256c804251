#include "services/runtime/process.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "services/runtime/hang_signal.h"
#include "services/runtime/identity.h"

namespace giveway {
namespace {

using namespace std::chrono_literals;

TEST(HangSignal, OneMakesTheLoopHangAndTheOtherLetsItGo) {
  EXPECT_FALSE(HangSignal::IsUp());
  const HangSignal drill;
  EXPECT_FALSE(HangSignal::IsUp());
  std::raise(HangSignal::kHang);
  EXPECT_TRUE(HangSignal::IsUp());
  std::raise(HangSignal::kHang);
  EXPECT_TRUE(HangSignal::IsUp());
  std::raise(HangSignal::kResume);
  EXPECT_FALSE(HangSignal::IsUp());
  // To one that was restarted meanwhile, and does not hang.
  std::raise(HangSignal::kResume);
  EXPECT_FALSE(HangSignal::IsUp());
}

// A vehicle that has just been started by a soak was ended by one.
TEST(HangSignal, ThoseThatCameBeforeItWaitAndAreHandledInOrder) {
  sigset_t both;
  sigset_t before;
  sigemptyset(&both);
  sigaddset(&both, HangSignal::kHang);
  sigaddset(&both, HangSignal::kResume);
  pthread_sigmask(SIG_BLOCK, &both, &before);
  std::raise(HangSignal::kHang);
  {
    const HangSignal drill;
    EXPECT_TRUE(HangSignal::IsUp());
  }
  pthread_sigmask(SIG_BLOCK, &both, nullptr);
  std::raise(HangSignal::kResume);
  std::raise(HangSignal::kHang);
  const HangSignal drill;
  EXPECT_FALSE(HangSignal::IsUp());
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TEST(Identity, IsReadFromTheProcessThatPublishesIt) {
  const Identity before{kNoVehicle, "010f45d2a3b1000001000000"};
  const Identity after{VehicleId{4'000'000'000}, "010f45d2a3b1000001000000"};
  EXPECT_EQ(ParseIdentity(ToText(after)), after);
  PublishIdentity(before);
  EXPECT_EQ(ReadIdentity("/proc/self"), before);
  PublishIdentity(after);
  EXPECT_EQ(ReadIdentity("/proc/self"), after);
  PublishIdentity(before);
  EXPECT_EQ(ReadIdentity("/proc/self"), before);
}

TEST(Identity, AndTheHeapOfAProcessAreReadEachByItself) {
  PublishHeap(12'345'678);
  EXPECT_EQ(ReadHeap("/proc/self"), 12'345'678u);
  PublishIdentity({VehicleId{7}, "010f45d2a3b1000001000000"});
  PublishHeap(99);
  EXPECT_EQ(ReadHeap("/proc/self"), 99u);
  EXPECT_EQ(ReadIdentity("/proc/self")->vehicle, VehicleId{7});
  EXPECT_FALSE(ReadHeap("/proc/self/task"));
}

TEST(Identity, ThatIsNotWholeIsNone) {
  const std::string whole = ToText({VehicleId{7}, "010f45d2a3b1000001000000"});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(ParseIdentity(whole.substr(0, length))) << length;
  }
  EXPECT_FALSE(ParseIdentity("vehicle 99999999999\nparticipant 010f45d2a3b1000001000000\n"));
  EXPECT_FALSE(ParseIdentity("vehicle 7\nparticipant 010f45d2a3b100000100000x\n"));
  EXPECT_FALSE(ReadIdentity("/proc/self/task"));
}

TEST(Ticker, OnTimeNothingIsMissed) {
  const NextTick next = AfterDeadline(100ms, 50ms, 60ms);
  EXPECT_EQ(next.deadline, SteadyTime{150ms});
  EXPECT_EQ(next.missed, 0U);
}

TEST(Ticker, LateWithinAPeriodKeepsTheGrid) {
  const NextTick next = AfterDeadline(100ms, 50ms, 149ms);
  EXPECT_EQ(next.deadline, SteadyTime{150ms});
  EXPECT_EQ(next.missed, 0U);
}

TEST(Ticker, WholePeriodsAreMissedAndNeverCaughtUp) {
  const NextTick one = AfterDeadline(100ms, 50ms, 150ms);
  EXPECT_EQ(one.deadline, SteadyTime{200ms});
  EXPECT_EQ(one.missed, 1U);
  const NextTick many = AfterDeadline(100ms, 50ms, 620ms);
  EXPECT_EQ(many.deadline, SteadyTime{650ms});
  EXPECT_EQ(many.missed, 10U);
}

TEST(Process, ARandomNumberIsNeverZeroAndRarelyTheSame) {
  const std::uint32_t first = RandomNonZero();
  EXPECT_NE(first, 0U);
  EXPECT_FALSE(RandomNonZero() == first && RandomNonZero() == first);
}

TEST(StopSignal, SetsAFlagOnInterruptAndTerminate) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const StopSignal stop;
    EXPECT_FALSE(stop.IsSet());
    std::raise(signal);
    EXPECT_TRUE(stop.IsSet());
  }
}

TEST(StopSignal, SurvivesABrokenPipeAndRestoresWhatWasThere) {
  struct sigaction before {};
  sigaction(SIGPIPE, nullptr, &before);
  {
    const StopSignal stop;
    std::raise(SIGPIPE);
    EXPECT_FALSE(stop.IsSet());
  }
  struct sigaction after {};
  sigaction(SIGPIPE, nullptr, &after);
  EXPECT_EQ(after.sa_handler, before.sa_handler);
  sigaction(SIGTERM, nullptr, &after);
  EXPECT_EQ(after.sa_handler, SIG_DFL);
}

// One request may arrive twice: `timeout` signals its child and the child's process group.
TEST(StopSignal, TheSameRequestSentTwiceEndsNothing) {
  const StopSignal stop;
  std::raise(SIGTERM);
  for (int i = 0; i < 50; ++i) std::raise(SIGTERM);
  EXPECT_TRUE(stop.IsSet());
}

// Whether a library hangs or a loop never checks for the request: the process ends.
TEST(StopSignalDeathTest, AProcessThatDoesNotLeaveIsEndedASecondAfterTheFirstSignal) {
  EXPECT_EXIT(
      {
        const StopSignal stop;
        std::raise(SIGTERM);
        for (;;) ::pause();
      },
      testing::ExitedWithCode(128 + SIGTERM), "");
}

TEST(StopSignalDeathTest, TheSecondSignalEndsAProcessThatDoesNotLeave) {
  const SteadyTime begun = SteadyNow();
  EXPECT_EXIT(
      {
        const StopSignal stop;
        std::raise(SIGTERM);
        while (SteadyNow() - begun < 2 * StopSignal::kSameRequest) {
        }
        ::alarm(0);  // the limit on the time is not what ends it
        std::raise(SIGINT);
        for (;;) ::pause();
      },
      testing::ExitedWithCode(128 + SIGINT), "");
}

TEST(StopSignal, AFileThatMayNotGrowEndsNothing) {
  const StopSignal stop;
  std::raise(SIGXFSZ);
  EXPECT_FALSE(stop.IsSet());
}

// Regression: started by a program that ignores SIGCHLD, a service could not wait for the process
// that tests the profiles of an order.
TEST(StopSignal, AParentThatIgnoredChildrenIsNotFollowed) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  struct sigaction meanwhile {};
  {
    const StopSignal stop;
    sigaction(SIGCHLD, nullptr, &meanwhile);
  }
  EXPECT_EQ(meanwhile.sa_handler, SIG_DFL);
  EXPECT_EQ(std::signal(SIGCHLD, before), SIG_IGN) << "not as it was";
}

TEST(StopSignalDeathTest, TwoAtATimeAreOurBug) {
  const StopSignal stop;
  EXPECT_DEATH(StopSignal(), "check failed");
}

}  // namespace
}  // namespace giveway
