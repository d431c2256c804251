// The end of a child that another part of the system has reaped; tests/system has the rest.
#include "services/fleetctl/process/child_process.h"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <string>

namespace giveway::fleetctl {
namespace {

class ChildSignalIgnored {
 public:
  ChildSignalIgnored() : before_(std::signal(SIGCHLD, SIG_IGN)) {}
  ~ChildSignalIgnored() { std::signal(SIGCHLD, before_); }
  ChildSignalIgnored(const ChildSignalIgnored&) = delete;
  ChildSignalIgnored& operator=(const ChildSignalIgnored&) = delete;

 private:
  void (*before_)(int);
};

// Blocks until the process has ended; the system reaps it, so there is nothing to learn of it.
void AwaitSelfReaped(pid_t pid) {
  siginfo_t ended{};
  EXPECT_EQ(::waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOWAIT), -1);
  EXPECT_EQ(errno, ECHILD);
}

// Regression: started by a program that ignores SIGCHLD, `fleetctl run` waited for its vehicles for
// ever.
TEST(ChildProcessEnd, IsNoticedWhereTheSystemReapsIt) {
  const ChildSignalIgnored ignored;
  ChildProcess child({"true", {"/bin/true"}, "", -1});
  AwaitSelfReaped(child.Pid());
  child.Poll();
  ASSERT_FALSE(child.IsRunning());
  EXPECT_EQ(child.End(), (ProcessEnd{false, ProcessEnd::kNotKnown}));
  EXPECT_NE(child.End(), ProcessEnd{}) << "no success";
  EXPECT_EQ(Describe(*child.End()), "exit code not known");
}

// Regression: a service that starts a process itself could not wait for it either.
TEST(ChildProcessEnd, IgnoresNoSignalOfItsOwnChildren) {
  const ChildSignalIgnored ignored;
  ChildProcess child({"grep", {"/bin/grep", "SigIgn", "/proc/self/status"}, "", -1});
  AwaitSelfReaped(child.Pid());
  child.Poll();
  ASSERT_THAT(child.LastLines(), testing::SizeIs(1));
  const std::string line = child.LastLines().front();  // "SigIgn: 0000000000010000"
  const auto ignores = std::stoull(line.substr(line.find(':') + 1), nullptr, 16);
  EXPECT_EQ(ignores & (1ULL << (SIGCHLD - 1)), 0U) << line;
}

}  // namespace
}  // namespace giveway::fleetctl
