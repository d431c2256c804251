// An interrupted verb ends whatever it is doing, even if a library hangs.
#include "services/fleetctl/process/interrupts.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

namespace giveway::fleetctl {
namespace {

constexpr int kInterrupted = 1;

[[noreturn]] void Hang() {
  for (;;) ::pause();
}

TEST(Interrupts, AreCounted) {
  const Interrupts interrupts;
  EXPECT_EQ(Interrupts::Count(), 0);
  std::raise(SIGINT);
  std::raise(SIGTERM);
  EXPECT_EQ(Interrupts::Count(), 2);
}

TEST(InterruptsDeathTest, AVerbThatHangsIsEndedASecondAfterTheFirst) {
  EXPECT_EXIT(
      {
        const Interrupts interrupts;
        std::raise(SIGINT);
        Hang();
      },
      testing::ExitedWithCode(kInterrupted), "");
}

TEST(InterruptsDeathTest, AVerbThatComputesIsEndedByTheThird) {
  EXPECT_EXIT(
      {
        const Interrupts interrupts(Silence::kComputes);
        for (int i = 0; i < 3; ++i) std::raise(SIGTERM);
        Hang();
      },
      testing::ExitedWithCode(kInterrupted), "");
}

// 1 would be a verdict of theirs: "an invariant is broken".
TEST(InterruptsDeathTest, AVerbWithAVerdictIsEndedWithTheFirstSignalsCode) {
  for (const int first : {SIGINT, SIGTERM}) {
    EXPECT_EXIT(
        {
          const Interrupts interrupts(Silence::kComputes, HardExit::kAsSignal);
          std::raise(first);
          std::raise(SIGTERM);
          std::raise(SIGTERM);
          Hang();
        },
        testing::ExitedWithCode(128 + first), "");
  }
}

TEST(Interrupts, KnowTheFirstSignal) {
  const Interrupts interrupts(Silence::kComputes, HardExit::kAsSignal);
  std::raise(SIGINT);
  std::raise(SIGTERM);
  EXPECT_EQ(Interrupts::SignalCode(), 128 + SIGINT);
}

}  // namespace
}  // namespace giveway::fleetctl
