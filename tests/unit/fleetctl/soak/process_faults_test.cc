// What a vehicle is started with again. What the faults do to processes is in tests/system/soak.sh.
#include "services/fleetctl/soak/process_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

MemberCommand Vehicle(std::vector<std::string> words) {
  MemberCommand vehicle;
  vehicle.member = MemberOf(VehicleId{1});
  vehicle.child.words = std::move(words);
  return vehicle;
}

// What one with these words is started with again, `now` being 12 s after the start signal.
std::vector<std::string> WordsAgain(const std::vector<std::string>& words) {
  FaultTools tools;
  MemberCommand vehicle = Vehicle(words);
  vehicle.start_after = std::chrono::hours(1);  // never here
  tools.commands = {vehicle};
  FleetProcesses processes(tools.commands);
  ProcessFaults faults(std::move(tools), &processes);
  faults.Turn(seconds(100), 0);
  EXPECT_EQ(faults.CommandNow(vehicle.member).child.words, words) << "before the start signal";
  faults.Turn(seconds(112), 12);
  faults.Turn(seconds(200), 100);
  return faults.CommandNow(vehicle.member).child.words;
}

TEST(ProcessFaults, TheRulesOfOneThatRestartsCountFromTheStartSignal) {
  EXPECT_THAT(WordsAgain({"giveway-vehicle", "--impair", "@rules"}),
              ElementsAre("giveway-vehicle", "--impair", "@rules", "--impair-since", "100.000000"));
}

TEST(ProcessFaults, OneWithoutRulesIsStartedAsBefore) {
  EXPECT_THAT(WordsAgain({"giveway-vehicle"}), ElementsAre("giveway-vehicle"));
}

faults::Fault On(faults::Kind kind) {
  faults::Fault fault;
  fault.kind = kind;
  fault.for_s = 5;
  fault.target.vehicle = VehicleId{1};
  return fault;
}

class ProcessFaultsTest : public testing::Test {
 protected:
  void StartWith(const MemberCommand& vehicle) {
    FaultTools tools;
    tools.commands = {vehicle};
    processes_.emplace(tools.commands);
    faults_.emplace(std::move(tools), &*processes_);
  }
  // Until the process has ended.
  void WaitForItsEnd() {
    const SteadyTime limit = SteadyNow() + seconds(10);
    while (!processes_->EndOf(kMember) && SteadyNow() < limit) processes_->Poll();
    ASSERT_TRUE(processes_->EndOf(kMember));
  }

  static constexpr MemberId kMember{MemberKind::kVehicle, 1};
  std::optional<FleetProcesses> processes_;
  std::optional<ProcessFaults> faults_;
};

// It passed by the SIGKILL that comes before it, whether any set did not match or not.
TEST_F(ProcessFaultsTest, TheEndOfAProcessIsNotTheEffectOfAMismatch) {
  StartWith(Vehicle({"/bin/sleep", "60"}));
  const faults::Schedule schedule{On(faults::Kind::kQosMismatch), On(faults::Kind::kRestart)};
  faults_->Begin(schedule[0]);
  EXPECT_TRUE(faults_->IsAway(kMember));
  EXPECT_THAT(faults_->KillersOf(kMember, schedule), IsEmpty());
  StartWith(Vehicle({"/bin/sleep", "60"}));
  faults_->Begin(schedule[1]);
  EXPECT_THAT(faults_->KillersOf(kMember, schedule), ElementsAre(1));
}

// As on a full disk. The soak ended by it, without a verdict.
TEST_F(ProcessFaultsTest, OneThatCannotBeStartedAgainIsHandedBack) {
  MemberCommand vehicle = Vehicle({"/bin/sleep", "60"});
  StartWith(vehicle);
  const faults::Schedule schedule{On(faults::Kind::kRestart)};
  FaultTools tools;
  vehicle.child.log_file = "/nowhere/vehicle-1.log";
  tools.commands = {vehicle};
  ProcessFaults faults(std::move(tools), &*processes_);
  faults.Begin(schedule[0]);
  WaitForItsEnd();
  faults.End(schedule[0]);
  faults.Turn(seconds(1), 1);
  const std::vector<FailedStart> failed = faults.TakeFailedStarts();
  ASSERT_THAT(failed, SizeIs(1));
  EXPECT_EQ(failed[0].member, kMember);
  EXPECT_THAT(failed[0].why, testing::HasSubstr("/nowhere"));
  EXPECT_FALSE(faults.IsAway(kMember)) << "it is missed from then on";
  EXPECT_THAT(faults.TakeFailedStarts(), IsEmpty());
}

TEST_F(ProcessFaultsTest, OneThatCannotBeStartedIsDueAgainLater) {
  StartWith(Vehicle({"/bin/true"}));
  WaitForItsEnd();
  FleetRestarts restarts(&*processes_);
  const auto command = [](bool has_log) {
    return [has_log](MemberId) {
      MemberCommand vehicle = Vehicle({"/bin/sleep", "60"});
      if (!has_log) vehicle.child.log_file = "/nowhere/vehicle-1.log";
      return vehicle;
    };
  };
  restarts.NoteEnd(kMember, seconds(1));
  ASSERT_THAT(restarts.Turn(seconds(1), command(false)), SizeIs(1));
  EXPECT_THAT(restarts.Turn(seconds(1), command(true)), IsEmpty());
  EXPECT_FALSE(processes_->IsRunning(kMember)) << "it waits";
  EXPECT_THAT(restarts.Turn(seconds(2), command(true)), IsEmpty());
  EXPECT_TRUE(processes_->IsRunning(kMember));
}

}  // namespace
}  // namespace giveway::fleetctl
