#include "services/runtime/crash_fallback.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/config/text_file.h"

namespace giveway {
namespace {

// The wait status of a child process that runs `act`.
int StatusOf(const std::function<void()>& act) {
  const pid_t process = fork();
  if (process == 0) {
    act();
    _exit(77);
  }
  int status = 0;
  EXPECT_EQ(waitpid(process, &status, 0), process);
  return status;
}

// The argument after this one on the command line.
std::optional<std::string> Argument(const std::string& name) {
  const std::vector<std::string> own = OwnArguments();
  const auto found = std::ranges::find(own, name);
  if (found == own.end() || found + 1 == own.end()) return std::nullopt;
  return found[1];
}

const std::vector<int> kAll{kCrashSignals.begin(), kCrashSignals.end()};

// Runs twice: as a test, and as the image that its child process comes back as.
TEST(CrashFallback, LeadsOnFromTheSignalsThatEndAProcess) {
  if (const auto why = Argument("--why")) {
    EXPECT_EQ(why, "it ended by signal " + Argument("--by").value_or(""));
    EXPECT_EQ(ReadBytes(Argument("--held").value_or("")), "<dds/>");
    EXPECT_EQ(fcntl(std::stoi(Argument("--open").value_or("")), F_GETFD), -1) << "still open";
    sigset_t held_back;
    sigprocmask(SIG_BLOCK, nullptr, &held_back);
    EXPECT_FALSE(sigismember(&held_back, std::stoi(Argument("--by").value_or("")))) << *why;
    EXPECT_TRUE(sigismember(&held_back, SIGTERM)) << "a stop is lost";
    return;
  }
  for (const int ending : kAll) {
    const int status = StatusOf([&] {
      const StopSignal stop;
      const HeldText text("mine.xml", "<dds/>");
      const int open_file = open("/dev/null", O_RDONLY);
      const CrashFallback way(kAll,
                              {{"--gtest_filter=CrashFallback.LeadsOn*", "x"},
                               {"--by", std::to_string(ending)},
                               {"--open", std::to_string(open_file)},
                               {"--held", text.Path()}},
                              "--why", stop);
      std::raise(ending);
    });
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << ending << ": " << status;
  }
}

TEST(CrashFallback, IsNoneForAProcessThatWasToldToStop) {
  const int status = StatusOf([] {
    const StopSignal stop;
    const CrashFallback way(kAll, {{"--gtest_filter=None", "x"}}, "--why", stop);
    std::raise(SIGTERM);
    std::raise(SIGBUS);
  });
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGBUS) << status;
}

TEST(CrashFallback, IsOverWithItsScope) {
  const int status = StatusOf([] {
    const StopSignal stop;
    { const CrashFallback way(kAll, {{"--gtest_filter=None", "x"}}, "--why", stop); }
    std::raise(SIGBUS);
  });
  EXPECT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "it came back";
}

TEST(CrashFallback, LeavesTheSignalsThatItIsNotForAlone) {
  const int status = StatusOf([] {
    const StopSignal stop;
    const CrashFallback way({SIGBUS}, {{"--gtest_filter=None", "x"}}, "--why", stop);
    std::raise(SIGABRT);
  });
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT) << status;
}

// As the trial of a profile set is followed by the guard against full memory.
TEST(CrashFallback, OfOneAfterAnotherTheLastHolds) {
  if (const auto why = Argument("--second")) {
    EXPECT_EQ(why, "it ended by signal " + std::to_string(SIGBUS));
    return;
  }
  const int status = StatusOf([] {
    const StopSignal stop;
    { const CrashFallback first(kAll, {{"--gtest_filter=None", "x"}}, "--first", stop); }
    const CrashFallback second({SIGBUS}, {{"--gtest_filter=CrashFallback.OfOne*", "x"}}, "--second",
                               stop);
    std::raise(SIGBUS);
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(CrashFallback, IsTheSameForWhatIsNoSignal) {
  const StopSignal stop;
  const CrashFallback way(kAll, {{"--qos", "former.xml"}}, "--why", stop);
  EXPECT_EQ(way.Because("no such profile"),
            (NewFlags{{"--qos", "former.xml"}, {"--why", "no such profile"}}));
}

}  // namespace
}  // namespace giveway
