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

}  // namespace
}  // namespace giveway::fleetctl
