// An interrupted verb ends whatever it is doing, even if a library hangs.
#include "services/fleetctl/process/interrupts.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <string>

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

// Ctrl-C before or while a verb wrote what takes longer than a second ended it in the middle of the
// file.
TEST(Interrupts, AVerbThatWritesHasTheTimeItAskedFor) {
  const Interrupts interrupts;
  Interrupts::AllowSeconds(30);
  std::raise(SIGINT);
  EXPECT_GT(::alarm(0), 1U);
  EXPECT_EQ(Interrupts::Count(), 1);
  EXPECT_GT(::alarm(0), 1U);
}

TEST(InterruptsDeathTest, AVerbThatHangsIsEndedASecondAfterTheFirst) {
  EXPECT_EXIT(
      {
        const Interrupts interrupts;
        std::raise(SIGINT);
        Hang();
      },
      testing::ExitedWithCode(kInterrupted), "did not stop in time");
}

TEST(InterruptsDeathTest, AVerbThatComputesIsEndedByTheThird) {
  EXPECT_EXIT(
      {
        const Interrupts interrupts(Silence::kComputes);
        for (int i = 0; i < 3; ++i) std::raise(SIGTERM);
        Hang();
      },
      testing::ExitedWithCode(kInterrupted), "ended at once");
}

// Regression: the cursor of the terminal stayed hidden.
TEST(InterruptsDeathTest, OneThatIsEndedWritesWhatItsDestructorsWouldHave) {
  EXPECT_EXIT(
      {
        ::dup2(STDERR_FILENO, STDOUT_FILENO);
        const Interrupts interrupts(Silence::kComputes);
        Interrupts::WriteIfEnded("not this");
        Interrupts::WriteIfEnded("cursor back");
        for (int i = 0; i < 3; ++i) std::raise(SIGTERM);
        Hang();
      },
      testing::ExitedWithCode(kInterrupted), "^cursor back");
}

// To say why it ends, it waited for who does not read.
TEST(InterruptsDeathTest, APipeThatIsNotReadKeepsNoneFromItsEnd) {
  EXPECT_EXIT(
      {
        int ends[2];
        if (::pipe(ends) != 0 || ::fcntl(ends[1], F_SETFL, O_NONBLOCK) != 0) ::_exit(3);
        const std::string page(4096, 'x');
        while (::write(ends[1], page.data(), page.size()) > 0) continue;
        ::fcntl(ends[1], F_SETFL, 0);
        ::dup2(ends[1], STDERR_FILENO);
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
