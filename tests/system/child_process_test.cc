// Real processes and real time: what a pure test cannot say of ChildProcess.
#include "services/fleetctl/process/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

ChildCommand Shell(const std::string& script) {
  return {"the shell", {"/bin/sh", "-c", script}, "", -1};
}

// Polls until `done`, at most five seconds.
template <typename Condition>
bool WaitFor(ChildProcess* child, Condition done) {
  for (int i = 0; i < 500; ++i) {
    child->Poll();
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

bool WaitForEnd(ChildProcess* child) {
  return WaitFor(child, [child] { return !child->IsRunning(); });
}

bool IsAlive(pid_t pid) { return ::kill(pid, 0) == 0; }

TEST(ChildProcess, ExitCodeAndLastLinesAreKept) {
  ChildProcess child(Shell("echo to stdout; echo to stderr >&2; printf unfinished; exit 3"));
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_EQ(child.End(), (ProcessEnd{false, 3}));
  EXPECT_EQ(Describe(*child.End()), "exit code 3");
  EXPECT_THAT(child.LastLines(), ElementsAre("to stdout", "to stderr", "unfinished"));
}

// A port of fleetctl's own, an id and a question made every child the same, or no service at all.
TEST(ChildProcess, IsGivenOnlyTheVariablesThatAreMeantForIt) {
  const std::vector<const char*> names{
      "GIVEWAY_HEALTH_PORT", "GIVEWAY_HEALTH",     "GIVEWAY_ID", "GIVEWAY_RECORD",
      "GIVEWAY_LOG_FORMAT",  "GIVEWAY_CONFIG_DIR", "NO_TWIN"};
  std::string script = "echo";
  for (const char* name : names) {
    ::setenv(name, "set", 1);
    script += std::string(" ${") + name + ":-none}";
  }
  ChildCommand command = Shell(script);
  ChildProcess child(command);
  command.flags_only = true;
  ChildProcess measured(command);
  for (const char* name : names) ::unsetenv(name);
  ASSERT_TRUE(WaitForEnd(&child) && WaitForEnd(&measured));
  EXPECT_THAT(child.LastLines(), ElementsAre("none none none none set set set"));
  EXPECT_THAT(measured.LastLines(), ElementsAre("none none none none none set set"));
}

TEST(ChildProcess, EveryLineIsHandedOnOnceWhereThatIsAskedFor) {
  ChildCommand command = Shell("for i in $(seq 1 1000); do echo line $i; done");
  ChildProcess silent(command);
  command.hands_on_lines = true;
  ChildProcess child(command);
  ASSERT_TRUE(WaitForEnd(&child) && WaitForEnd(&silent));
  const std::vector<std::string> lines = child.TakeLines();
  ASSERT_THAT(lines, SizeIs(1000));
  EXPECT_EQ(lines.front(), "line 1");
  EXPECT_THAT(child.TakeLines(), SizeIs(0));
  EXPECT_THAT(silent.TakeLines(), SizeIs(0));
}

TEST(ChildProcess, OnlyTheLastTwentyLinesAreKept) {
  ChildProcess child(Shell("for i in $(seq 1 1000); do echo line $i; done"));
  ASSERT_TRUE(WaitForEnd(&child));
  ASSERT_THAT(child.LastLines(), SizeIs(ChildProcess::kLinesKept));
  EXPECT_EQ(child.LastLines().front(), "line 981");
  EXPECT_EQ(child.LastLines().back(), "line 1000");
}

TEST(ChildProcess, MegabytesWithoutALineFeedStayBounded) {
  ChildProcess child(Shell("head -c 5000000 /dev/zero | tr '\\0' x"));
  ASSERT_TRUE(WaitForEnd(&child));
  ASSERT_THAT(child.LastLines(), SizeIs(1));
  EXPECT_LE(child.LastLines()[0].size(), 2000U);
}

TEST(ChildProcess, IsAskedToStopOnce) {
  ChildProcess child(Shell("trap 'echo asked' TERM; echo ready; while :; do sleep 0.01; done"));
  const auto lines = [&child](std::size_t count) {
    return WaitFor(&child, [&] { return child.LastLines().size() >= count; });
  };
  ASSERT_TRUE(lines(1));
  child.AskToStop();
  ASSERT_TRUE(lines(2));
  child.AskToStop();
  child.Signal(SIGINT);  // which ends it, after whatever came before
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_THAT(child.LastLines(), ElementsAre("ready", "asked"));
}

TEST(ChildProcess, DeathBySignalIsNamed) {
  ChildProcess child(Shell("sleep 60"));
  child.Signal(SIGKILL);
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_EQ(Describe(*child.End()), "signal 9 (Killed)");
}

TEST(ChildProcess, ProgramThatIsNotThereSaysSo) {
  ChildProcess child({"nobody", {"/does/not/exist"}, "", -1});
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_EQ(child.End(), (ProcessEnd{false, 127}));
  EXPECT_THAT(child.LastLines(), ElementsAre(HasSubstr("cannot start /does/not/exist: No such")));
}

TEST(ChildProcess, DestructionKillsAndReapsAChildThatIgnoresSigterm) {
  pid_t pid = 0;
  {
    ChildProcess child(Shell("trap '' TERM; echo ready; while :; do sleep 1; done"));
    pid = child.Pid();
    ASSERT_TRUE(WaitFor(&child, [&child] { return !child.LastLines().empty(); }));
    child.Signal(SIGTERM);
  }
  EXPECT_FALSE(IsAlive(pid));
}

TEST(ChildProcess, ChildSeesNoDescriptorButTheStandardOnesAndTheKeptOne) {
  const int leaked = ::dup(STDERR_FILENO);  // not close-on-exec, as the library's sockets are
  const int kept = ::dup(STDERR_FILENO);
  // The shell opens the directory of its own descriptors to list it: that one is not counted.
  ChildCommand command{"ls", {"/bin/ls", "/proc/self/fd"}, "", kept};
  ChildProcess child(command);
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_THAT(child.LastLines(), ElementsAre("0", "1", "2", "3", "4"));
  command.kept_fd = -1;
  ChildProcess without(command);
  ASSERT_TRUE(WaitForEnd(&without));
  EXPECT_THAT(without.LastLines(), ElementsAre("0", "1", "2", "3"));
  ::close(leaked);
  ::close(kept);
}

TEST(ChildProcess, SignalsBlockedOrIgnoredHereReachTheChild) {
  struct sigaction before {};
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGTERM, &ignore, &before);
  ChildProcess child({"sleep", {"/bin/sleep", "60"}, "", -1});
  ::sigaction(SIGTERM, &before, nullptr);
  // A signal between fork and exec would find the handler of this process.
  ASSERT_TRUE(WaitFor(&child, [&child] {
    return std::filesystem::read_symlink("/proc/" + std::to_string(child.Pid()) + "/exe")
               .filename() == "sleep";
  }));
  child.Signal(SIGTERM);
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_EQ(child.End(), (ProcessEnd{true, SIGTERM}));
}

bool IsGoneOrUnreaped(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string id, name, state;
  return !(stat >> id >> name >> state) || state == "Z";
}

// Also one that handles signals and does not come to them, and one that is stopped: `fleetctl
// stopwatch` has both.
class KilledParent : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(ChildProcess, KilledParent,
                         testing::Values("exec sleep 60",
                                         "trap '' TERM INT; while :; do sleep 1; done",
                                         "kill -STOP $$"));

TEST_P(KilledParent, TakesItsChildWithIt) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t parent = ::fork();
  ASSERT_GE(parent, 0);
  if (parent == 0) {
    ChildProcess child(Shell(GetParam()));
    const pid_t pid = child.Pid();
    if (::write(pipe[1], &pid, sizeof pid) != sizeof pid) ::_exit(1);
    for (;;) ::pause();
  }
  pid_t orphan = 0;
  EXPECT_EQ(::read(pipe[0], &orphan, sizeof orphan), static_cast<ssize_t>(sizeof orphan));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(IsGoneOrUnreaped(orphan));
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  bool gone = false;
  for (int i = 0; i < 200 && !gone; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    gone = IsGoneOrUnreaped(orphan);
  }
  EXPECT_TRUE(gone);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(ChildProcess, LogFileHoldsEverythingItSaid) {
  ChildCommand command = Shell("for i in $(seq 1 100); do echo line $i; done");
  command.log_file = testing::TempDir() + "child_log_" + std::to_string(::getpid());
  ChildProcess child(command);
  ASSERT_TRUE(WaitForEnd(&child));
  std::ifstream log(command.log_file);
  std::string line;
  int lines = 0;
  while (std::getline(log, line)) ++lines;
  EXPECT_EQ(lines, 100);
  std::filesystem::remove(command.log_file);
}

}  // namespace
}  // namespace giveway::fleetctl
