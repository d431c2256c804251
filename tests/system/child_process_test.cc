// Real processes and real time: the parts of ChildProcess and FleetProcesses that no pure test
// covers.
#include "services/fleetctl/process/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "services/fleetctl/process/fleet_processes.h"
#include "services/fleetctl/process/fleet_restarts.h"

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

ChildCommand Shell(const std::string& script) {
  return {"the shell", {"/bin/sh", "-c", script}, "", -1};
}

// Polls until `done`, at most five seconds.
template <typename Polled, typename Condition>
bool WaitFor(Polled* processes, Condition done) {
  for (int i = 0; i < 500; ++i) {
    processes->Poll();
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

// Regression: fleetctl's own environment variables of port, id and health check gave every child
// the same ones, or no service at all.
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

TEST(ChildProcess, WhatIsNotReadWaitsInItsPipe) {
  ChildProcess child(Shell("trap 'echo four' USR1; echo one; while :; do sleep 0.05; done"));
  ASSERT_TRUE(WaitFor(&child, [&] { return child.Output().read == 4; }));
  child.HearOutput(false);
  child.Signal(SIGUSR1);
  EXPECT_TRUE(WaitFor(&child, [&] { return child.Output().unread == 5; }));
  EXPECT_EQ(child.Output().read, 4U);
  child.HearOutput(true);
  EXPECT_TRUE(WaitFor(&child, [&] { return child.Output().read == 9; }));
  EXPECT_EQ(child.Output().unread, 0U);
}

// Regression: after one write that failed, the log had nothing more, and nothing said so.
TEST(ChildProcess, ALogThatCannotBeWrittenIsSaidAndWhatIsMissingCounted) {
  ChildCommand command = Shell("echo one; sleep 0.1; echo two");
  command.log_file = "/dev/full";
  ChildProcess child(command);
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_THAT(child.LastLines(), ElementsAre("one", "two"));
  EXPECT_THAT(child.TakeLogComplaints(),
              ElementsAre(HasSubstr("/dev/full: cannot be written: No space left on device"),
                          "/dev/full: 8 bytes are missing"));
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

// Regression: a world that was asked to stop before it handled SIGTERM was ended by it, and had not
// left in good order.
TEST(ChildProcess, AStopWaitsForOneThatHandlesIt) {
  ChildCommand command{"sleep", {"/bin/sleep", "0.2"}};  // a shell would let all signals pass
  command.handles_stops = true;
  ChildProcess child(command);
  child.AskToStop();
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_EQ(child.End(), (ProcessEnd{false, 0}));
}

TEST(ChildProcess, DeathBySignalIsNamed) {
  ChildProcess child(Shell("sleep 60"));
  child.Signal(SIGKILL);
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_EQ(Describe(*child.End()), "signal 9 (Killed)");
}

TEST(ChildProcess, ProgramThatIsNotThereSaysSo) {
  ChildProcess child({"absent", {"/does/not/exist"}, "", -1});
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
  child.Signal(SIGTERM);
  ASSERT_TRUE(WaitForEnd(&child));
  EXPECT_EQ(child.End(), (ProcessEnd{true, SIGTERM}));
}

bool IsGoneOrUnreaped(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string id, name, state;
  return !(stat >> id >> name >> state) || state == "Z";
}

// Also one that handles signals but does not get to them, and one that is stopped: `fleetctl
// stopwatch` has both.
class KilledParent : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(ChildProcess, KilledParent,
                         testing::Values("exec sleep 60",
                                         "trap '' TERM INT; while :; do sleep 1; done",
                                         "kill -STOP $$"));

// Kills a process that has started two others, and says whether these are gone then. `start` leaves
// them running and hands their ids over.
template <typename Start>
void KillParentOfTwo(Start start) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t parent = ::fork();
  ASSERT_GE(parent, 0);
  if (parent == 0) {
    start([&pipe](const std::array<pid_t, 2>& pids) {
      if (::write(pipe[1], pids.data(), sizeof pids) != sizeof pids) ::_exit(1);
      for (;;) ::pause();
    });
    ::_exit(1);
  }
  ::close(pipe[1]);
  std::array<pid_t, 2> orphans{};
  EXPECT_EQ(::read(pipe[0], orphans.data(), sizeof orphans), ssize_t{sizeof orphans});
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(std::ranges::any_of(orphans, IsGoneOrUnreaped));
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  bool gone = false;
  for (int i = 0; i < 200 && !gone; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    gone = std::ranges::all_of(orphans, IsGoneOrUnreaped);
  }
  EXPECT_TRUE(gone);
  ::close(pipe[0]);
}

TEST_P(KilledParent, TakesItsChildrenWithIt) {
  KillParentOfTwo([](const auto& hand_over) {
    ChildProcess one(Shell(GetParam()));
    ChildProcess other(Shell(GetParam()));
    hand_over({one.Pid(), other.Pid()});
  });
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

constexpr MemberId kOne = MemberOf(VehicleId{1});
constexpr MemberId kTwo = MemberOf(VehicleId{2});
constexpr auto kLate = std::chrono::milliseconds(200);
constexpr const char* kSleep = "exec sleep 60";
constexpr const char* kLeavesWithFive =
    "trap 'exit 5' TERM; echo ready; while :; do sleep 0.01; done";
constexpr const char* kDeafToSigterm = "trap '' TERM; echo ready; while :; do sleep 0.01; done";

MemberCommand Command(MemberId member, const std::string& script, Nanoseconds start_after = {}) {
  return {member, Shell(script), start_after};
}

bool WaitForEnd(FleetProcesses* fleet, MemberId member) {
  return WaitFor(fleet, [&] { return fleet->EndOf(member).has_value(); });
}

bool WaitForLine(FleetProcesses* fleet, MemberId member) {
  return WaitFor(fleet, [&] { return !fleet->LastLines(member).empty(); });
}

TEST_P(KilledParent, TakesItsFleetWithItRestartedAndLateOnesAlike) {
  KillParentOfTwo([](const auto& hand_over) {
    FleetProcesses fleet({Command(kOne, "exit 0"), Command(kTwo, GetParam(), kLate)});
    if (!WaitForEnd(&fleet, kOne)) return;
    fleet.Restart(Command(kOne, GetParam()));
    if (!WaitFor(&fleet, [&] { return fleet.IsRunning(kTwo); })) return;
    hand_over({*fleet.PidOf(kOne), *fleet.PidOf(kTwo)});
  });
}

TEST(FleetProcesses, StartEachInItsTime) {
  const auto begin = std::chrono::steady_clock::now();
  FleetProcesses fleet({Command(kOne, kSleep), Command(kTwo, kSleep, kLate)});
  EXPECT_TRUE(fleet.IsRunning(kOne));
  EXPECT_FALSE(fleet.AllEnded());
  ASSERT_TRUE(WaitFor(&fleet, [&] { return fleet.IsRunning(kTwo); }));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, kLate);
}

TEST(FleetProcesses, NothingMoreIsStartedOnceAllAreToStop) {
  FleetProcesses fleet({Command(kOne, kSleep), Command(kTwo, kSleep, kLate)});
  fleet.AskToStop();
  ASSERT_TRUE(WaitFor(&fleet, [&] { return fleet.AllEnded(); }));
  std::this_thread::sleep_for(2 * kLate);
  fleet.Poll();
  EXPECT_FALSE(fleet.IsRunning(kTwo));
  const std::vector<MemberEnd> ends = fleet.TakeEnds();
  ASSERT_THAT(ends, SizeIs(1));
  EXPECT_EQ(ends[0].how, (ProcessEnd{true, SIGTERM}));
}

// Regression: a log that could not be made ended the whole fleet, and the run with it.
TEST(FleetRestarts, OneThatCannotBeStartedLeavesTheOthersAloneAndIsStartedLater) {
  const std::filesystem::path folder =
      testing::TempDir() + "fleet_restarts_" + std::to_string(::getpid());
  std::filesystem::create_directory(folder);
  MemberCommand command = Command(kOne, "exit 1");
  command.child.log_file = folder / "one.log";
  FleetProcesses fleet({command, Command(kTwo, kSleep)});
  FleetRestarts restarts(&fleet);
  const auto command_of = [&fleet](MemberId member) { return fleet.CommandOf(member); };
  ASSERT_TRUE(WaitForEnd(&fleet, kOne));
  std::filesystem::remove_all(folder);

  SteadyTime now = std::chrono::seconds(1);
  restarts.NoteEnd(kOne, now);
  const std::vector<FailedStart> failed = restarts.Turn(now, command_of);
  ASSERT_THAT(failed, SizeIs(1));
  EXPECT_THAT(failed[0].why, HasSubstr("one+.log: No such file or directory"));
  EXPECT_TRUE(restarts.Awaits(kOne));
  EXPECT_TRUE(restarts.AwaitsAny([](MemberId member) { return member != kTwo; }));
  EXPECT_FALSE(restarts.AwaitsAny([](MemberId member) { return member == kTwo; }));
  EXPECT_THAT(restarts.Turn(now, command_of), SizeIs(0)) << "not at once";
  EXPECT_TRUE(fleet.IsRunning(kTwo));

  std::filesystem::create_directory(folder);
  now += RestartBackoff::kLongest;
  EXPECT_THAT(restarts.Turn(now, command_of), SizeIs(0));
  EXPECT_FALSE(restarts.Awaits(kOne));
  EXPECT_TRUE(std::filesystem::exists(folder / "one+.log"));
  std::filesystem::remove_all(folder);
}

TEST(FleetProcesses, ARestartedOneIsAnotherProcessWithALogOfItsOwn) {
  const std::filesystem::path folder =
      testing::TempDir() + "fleet_logs_" + std::to_string(::getpid());
  std::filesystem::create_directory(folder);
  MemberCommand command = Command(kOne, "echo first; exit 3");
  command.child.log_file = folder / "vehicle-1.log";
  FleetProcesses fleet({command, Command(kTwo, kSleep)});
  const pid_t other = *fleet.PidOf(kTwo);
  ASSERT_TRUE(WaitForEnd(&fleet, kOne));
  EXPECT_THAT(fleet.TakeEnds(), SizeIs(1));
  EXPECT_THAT(fleet.TakeEnds(), SizeIs(0));
  fleet.Restart(kOne);
  EXPECT_FALSE(fleet.EndOf(kOne).has_value());
  ASSERT_TRUE(WaitForEnd(&fleet, kOne));
  EXPECT_EQ(fleet.EndOf(kOne)->how, (ProcessEnd{false, 3}));
  EXPECT_THAT(fleet.TakeEnds(), SizeIs(1));
  command.child.words.back() = "echo second; exit 4";
  fleet.Restart(command);
  ASSERT_TRUE(WaitForEnd(&fleet, kOne));
  EXPECT_EQ(fleet.EndOf(kOne)->how, (ProcessEnd{false, 4}));
  EXPECT_THAT(fleet.LastLines(kOne), ElementsAre("second"));
  EXPECT_EQ(fleet.PidOf(kTwo), other);
  for (const auto& [file, word] : {std::pair("vehicle-1.log", "first"),
                                   {"vehicle-1+.log", "first"},
                                   {"vehicle-1++.log", "second"}}) {
    std::string line;
    std::ifstream(folder / file) >> line;
    EXPECT_EQ(line, word) << file;
  }
  std::filesystem::remove_all(folder);
}

TEST(FleetProcesses, OnlyAnEndJustAsPlannedIsPlanned) {
  FleetProcesses fleet({Command(kOne, kSleep), Command(kTwo, kLeavesWithFive)});
  const auto leave = [&fleet] {
    ASSERT_TRUE(WaitForLine(&fleet, kTwo));
    fleet.AskToStop(kTwo);
    ASSERT_TRUE(WaitForEnd(&fleet, kTwo));
  };
  fleet.Kill(kOne);
  ASSERT_TRUE(WaitForEnd(&fleet, kOne));
  EXPECT_TRUE(fleet.EndOf(kOne)->planned);
  fleet.Plan(kTwo, {false, 0});
  leave();
  EXPECT_FALSE(fleet.EndOf(kTwo)->planned);
  fleet.Restart(kTwo);
  fleet.Plan(kTwo, {false, 5});
  leave();
  EXPECT_TRUE(fleet.EndOf(kTwo)->planned);
  // A kill planned for the last process does not apply to the next.
  fleet.Restart(kTwo);
  leave();
  EXPECT_FALSE(fleet.EndOf(kTwo)->planned);
}

// Another process killed it first, which has not been noticed yet.
TEST(FleetProcesses, AKillOfOneThatIsDeadAlreadyPlansNothing) {
  FleetProcesses fleet({Command(kOne, kSleep)});
  const pid_t pid = *fleet.PidOf(kOne);
  ::kill(pid, SIGKILL);
  while (!IsGoneOrUnreaped(pid)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  fleet.Kill(kOne);
  ASSERT_TRUE(WaitForEnd(&fleet, kOne));
  EXPECT_EQ(fleet.EndOf(kOne)->how, (ProcessEnd{true, SIGKILL}));
  EXPECT_FALSE(fleet.EndOf(kOne)->planned);
}

TEST(FleetProcesses, WhoMayEndIsForTheCallerToSay) {
  FleetProcesses fleet(
      {Command(kTheWorld, kSleep), Command(kOne, "exit 0"), Command(kTwo, "exit 3")});
  const auto all = [](const MemberEnd&) { return true; };
  const auto nobody = [](const MemberEnd&) { return false; };
  const auto well = [](const MemberEnd& end) { return end.how == ProcessEnd{false, 0}; };
  ASSERT_TRUE(WaitForEnd(&fleet, kOne) && WaitForEnd(&fleet, kTwo));
  EXPECT_FALSE(fleet.FirstEndNotAllowed(all));
  ASSERT_TRUE(fleet.FirstEndNotAllowed(nobody) && fleet.FirstEndNotAllowed(well));
  EXPECT_EQ(fleet.FirstEndNotAllowed(nobody)->member, kOne);
  EXPECT_EQ(fleet.FirstEndNotAllowed(well)->member, kTwo);
  EXPECT_TRUE(fleet.AnyRunning([](MemberId member) { return member == kTheWorld; }));
  EXPECT_FALSE(fleet.AnyRunning([](MemberId member) { return member != kTheWorld; }));
}

TEST(FleetProcesses, OneThatIsPausedWakesAndLeavesWhenAskedTo) {
  FleetProcesses fleet({Command(kOne, kLeavesWithFive)});
  ASSERT_TRUE(WaitForLine(&fleet, kOne));
  fleet.Signal(kOne, SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  fleet.AskToStop(kOne);
  ASSERT_TRUE(WaitForEnd(&fleet, kOne));
  EXPECT_EQ(fleet.EndOf(kOne)->how, (ProcessEnd{false, 5}));
}

TEST(FleetProcesses, WhoDoesNotLeaveInTimeIsKilled) {
  FleetProcesses fleet({Command(kOne, kDeafToSigterm)});
  ASSERT_TRUE(WaitForLine(&fleet, kOne));
  fleet.EndAll(kLate, [&fleet] { fleet.Poll(); });
  EXPECT_EQ(fleet.EndOf(kOne)->how, (ProcessEnd{true, SIGKILL}));
}

TEST(FleetProcesses, LinesAreHandedOnWithWhoSaidThem) {
  MemberCommand one = Command(kOne, "echo one");
  MemberCommand two = Command(kTwo, "echo two");
  one.child.hands_on_lines = two.child.hands_on_lines = true;
  FleetProcesses fleet({one, two});
  ASSERT_TRUE(WaitForEnd(&fleet, kOne) && WaitForEnd(&fleet, kTwo));
  const std::vector<MemberLine> lines = fleet.TakeLines();
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_EQ(lines[0].member, kOne);
  EXPECT_EQ(lines[0].text, "one");
  EXPECT_EQ(lines[1].text, "two");
  EXPECT_THAT(fleet.TakeLines(), SizeIs(0));
}

TEST(FleetProcesses, ALiveOneIsMeasured) {
  FleetProcesses fleet(
      {Command(kOne, "exec 5</dev/null 6</dev/null; echo ready; while :; do :; done")});
  ASSERT_TRUE(WaitForLine(&fleet, kOne));
  std::optional<ProcessResources> resources;
  EXPECT_TRUE(WaitFor(&fleet, [&] {
    resources = fleet.ResourcesOf(kOne);
    return resources && resources->cpu_s > 0;
  }));
  ASSERT_TRUE(resources);
  EXPECT_EQ(resources->threads, 1U);
  EXPECT_EQ(resources->descriptors, 5U);
  EXPECT_GT(resources->private_bytes, 0U);
  EXPECT_GT(resources->resident_bytes, resources->private_bytes);
  fleet.Kill(kOne);
  ASSERT_TRUE(WaitForEnd(&fleet, kOne));
  EXPECT_FALSE(fleet.ResourcesOf(kOne));
  EXPECT_FALSE(fleet.PidOf(kOne));
}

}  // namespace
}  // namespace giveway::fleetctl
