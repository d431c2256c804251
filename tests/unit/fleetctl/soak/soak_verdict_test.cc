#include "services/fleetctl/soak/soak_verdict.h"

#include <gmock/gmock.h>

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};

// A run in which vehicle 1 was killed at 10 s, its peers noticed after 150 ms, and nothing failed.
class SoakVerdictTest : public testing::Test {
 protected:
  SoakVerdictTest() {
    faults::Fault kill;
    kill.rule = "die";
    kill.at_s = 10;
    kill.target.vehicle = kOne;
    schedule_.push_back(kill);
    seen_.started = true;
    seen_.lasted_s = 60;
    seen_.courses = {{seconds(10), seconds(10), "the process ended"}};
    Noticed() = milliseconds(10150);
    seen_.healing[kTwo] = 0.5;
    limits_.beacon_period = milliseconds(50);
    limits_.deadline = milliseconds(150);
  }
  std::optional<SteadyTime>& Noticed() {
    return seen_.courses[0].noticed[static_cast<std::size_t>(Mechanism::kDeadline)];
  }
  SoakResult Judged() const {
    SoakResult result;
    EvaluateSoak({seen_, schedule_, limits_, true, fleet_}, &result);
    return result;
  }

  faults::Schedule schedule_;
  SoakSeen seen_;
  Limits limits_;
  std::vector<VehicleId> fleet_;
};

TEST_F(SoakVerdictTest, PassesWhereEveryPromiseWasKept) {
  const SoakResult result = Judged();
  EXPECT_EQ(result.verdict, SoakVerdict::kPassed);
  EXPECT_THAT(result.reasons, IsEmpty());
  ASSERT_THAT(result.faults, SizeIs(1));
  EXPECT_NEAR(*result.faults[0].noticed_after_s, 0.15, 1e-9);
  EXPECT_TRUE(result.faults[0].observed);
}

TEST_F(SoakVerdictTest, FailsWhereAFaultHadNoEffect) {
  seen_.courses[0].effect.clear();
  const SoakResult result = Judged();
  EXPECT_EQ(result.verdict, SoakVerdict::kFailed);
  ASSERT_THAT(result.violations, SizeIs(1));
  EXPECT_EQ(result.violations[0].invariant, "effect");
  EXPECT_EQ(result.violations[0].fault, "die#0");
}

TEST_F(SoakVerdictTest, SaysWhyAFaultHadNothingToActOnAndDoesNotCountIt) {
  seen_.courses[0].effect.clear();
  seen_.courses[0].met_nothing = "it logged nothing meanwhile";
  const SoakResult result = Judged();
  EXPECT_EQ(result.verdict, SoakVerdict::kPassed);
  EXPECT_FALSE(result.faults[0].observed);
  EXPECT_EQ(result.faults_observed, 0U);
  EXPECT_EQ(result.faults[0].observed_how, "it logged nothing meanwhile");
  seen_.courses[0].effect = "its process ended";
  EXPECT_EQ(Judged().faults[0].observed_how, "its process ended");
}

TEST_F(SoakVerdictTest, TellsWhyAFaultCouldNotBeInjectedOrUndone) {
  seen_.courses[0].failure = "the order ended with exit code 1: refused";
  EXPECT_EQ(Judged().faults[0].observed_how,
            "the process ended; the order ended with exit code 1: refused");
  seen_.courses[0].effect.clear();
  EXPECT_EQ(Judged().faults[0].observed_how, "");
  EXPECT_THAT(Judged().violations.at(0).words, HasSubstr("seen: the order ended with exit code 1"));
}

TEST_F(SoakVerdictTest, FailsWhereNobodyNoticedOrTooLate) {
  Noticed() = seconds(14);
  EXPECT_EQ(Judged().violations.at(0).invariant, "detection");
  seen_.courses[0].paused[static_cast<std::size_t>(Mechanism::kLiveliness)] = seconds(5);
  EXPECT_EQ(Judged().verdict, SoakVerdict::kFailed) << "that was later";
  seen_.courses[0].paused[static_cast<std::size_t>(Mechanism::kDeadline)] = seconds(5);
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed) << "the machine stalled meanwhile";
  Noticed().reset();
  EXPECT_THAT(Judged().violations.at(0).words, HasSubstr("no peer noticed"));
}

TEST_F(SoakVerdictTest, FailsWhereADecisionUsedABeaconThatIsTooOld) {
  VehicleStatus status;
  status.vehicle = kTwo;
  FigureSummary& age = status.timing.figures[static_cast<std::size_t>(DriveFigure::kBeaconAge)];
  age.newest[age.count++] = 150'000;
  seen_.timing = FleetTiming(milliseconds(200));
  seen_.timing.Fold(status, 11);
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed);
  age.newest[age.count++] = 400'000;
  seen_.timing.Fold(status, 12);
  const SoakResult result = Judged();
  ASSERT_THAT(result.violations, SizeIs(1));
  EXPECT_EQ(result.violations[0].invariant, "stale_decision");
  EXPECT_EQ(result.violations[0].vehicle, kTwo);
  EXPECT_THAT(result.violations[0].words, HasSubstr("400 ms"));
}

TEST_F(SoakVerdictTest, TellsTheNarrowestMarginAndFiguresOfTheFleet) {
  VehicleStatus status;
  status.vehicle = kTwo;
  status.timing.narrowest = ReactionMargin{Tick{5}, 0.3, 0.31};
  status.timing.budget_spent = 1;
  FigureSummary& way =
      status.timing.figures[static_cast<std::size_t>(DriveFigure::kReactionDistance)];
  way.newest[way.count++] = 300'000;
  seen_.timing.Fold(status, 12);
  const SoakResult result = Judged();
  ASSERT_TRUE(result.narrowest_margin);
  EXPECT_EQ(result.narrowest_margin->reaction_m, 0.3);
  EXPECT_EQ(result.budget_spent, 1U);
  EXPECT_EQ(result.verdict, SoakVerdict::kPassed) << "an alarm is no broken promise";
  EXPECT_EQ(result.histograms.back().name, "reaction_way");
}

TEST_F(SoakVerdictTest, FailsWhereABeaconIsNotAccountedFor) {
  VehicleStatus status;
  status.vehicle = kTwo;
  BeaconAccount account{.writer = kOne, .first = 1, .last = 5, .accepted = 4, .lost = 1};
  status.accounts = {account};
  seen_.accounting.Fold(status);
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed);
  EXPECT_THAT(Judged().accounting, SizeIs(1));
  status.vehicle = kOne;
  status.accounts = {};
  status.beacons.accepted = 1;
  seen_.accounting.Fold(status);
  EXPECT_THAT(Judged().violations.at(0).words, HasSubstr("no account"));
  status.vehicle = kTwo;
  account.last = 7;
  status.accounts = {account};
  seen_.accounting.Fold(status);
  const SoakResult result = Judged();
  EXPECT_EQ(result.verdict, SoakVerdict::kFailed);
  ASSERT_THAT(result.violations, SizeIs(2));
  EXPECT_EQ(result.violations[0].invariant, "accounting");
  EXPECT_EQ(result.violations[0].vehicle, kTwo);
  EXPECT_EQ(result.violations[0].other, kOne);
  EXPECT_EQ(result.accounting[0].Difference(), 2);
}

// A report lists 5000 pairs.
TEST_F(SoakVerdictTest, APairThatDiffersIsListedFirstWhereThereAreTooMany) {
  VehicleStatus status;
  BeaconAccount account{.writer = kOne, .first = 1, .last = 5, .accepted = 5};
  for (std::uint32_t reader = 2; reader < kMostListed + 3; ++reader) {
    status.vehicle = VehicleId{reader};
    account.lost = reader == kMostListed + 2 ? 1 : 0;
    status.accounts = {account};
    seen_.accounting.Fold(status);
  }
  const SoakResult result = Judged();
  EXPECT_THAT(result.accounting, SizeIs(kMostListed + 1));
  EXPECT_EQ(result.accounting.at(0).Difference(), -1);
  EXPECT_EQ(result.accounting.at(1).reader, "vehicle 2");
  EXPECT_EQ(result.violations.at(0).invariant, "accounting");
}

TEST_F(SoakVerdictTest, DoesNotJudgeAFaultThatNeverBegan) {
  seen_.courses[0] = {};
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed);
}

TEST_F(SoakVerdictTest, FailsWhereOneDoesNotDriveAgain) {
  seen_.healing[kTwo] = 5.5;
  EXPECT_EQ(Judged().violations.at(0).invariant, "healing");
  seen_.healing[kTwo].reset();
  EXPECT_EQ(Judged().violations.at(0).vehicle, kTwo);
}

TEST_F(SoakVerdictTest, OneThatIsNoLongerHeardFailsItThoughItDroveAfterTheLastFault) {
  seen_.silent_s[kTwo] = 4.9;
  EXPECT_TRUE(Judged().violations.empty());
  seen_.silent_s[kTwo] = 5.1;
  EXPECT_EQ(Judged().violations.at(0).invariant, "silent");
}

// It passed: healing was never sought, and what had not come was not missed.
TEST_F(SoakVerdictTest, AWorldWhoseTimeStandsUntilTheEndFailsIt) {
  faults::Fault off;
  off.kind = faults::Kind::kSonarOff;
  schedule_.push_back(off);
  seen_.courses.emplace_back();
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed);
  seen_.world_stood_from_s = 12;
  const SoakResult result = Judged();
  EXPECT_EQ(result.verdict, SoakVerdict::kFailed);
  ASSERT_THAT(result.violations, SizeIs(1));
  EXPECT_EQ(result.violations[0].invariant, "world_stood");
  EXPECT_THAT(result.violations[0].words, HasSubstr("12.0 s to the end; 1 of the faults"));
}

// Violations were dated by the world's time, which lags, and followed other faults.
TEST_F(SoakVerdictTest, AFaultOfTheWorldIsDatedByWhenItStartedHere) {
  faults::Fault off;
  off.rule = "deaf";
  off.kind = faults::Kind::kSonarOff;
  off.at_s = 20;
  off.for_s = 2;
  off.target.vehicle = kTwo;
  schedule_.push_back(off);
  seen_.started_at = seconds(3);
  seen_.lasted_s = 90;
  seen_.courses[0].began = seen_.courses[0].ended = seconds(13);
  Noticed() = milliseconds(13150);
  seen_.courses.push_back({.began = seconds(48), .ended = seconds(50)});
  const SoakResult result = Judged();
  EXPECT_EQ(result.faults[1].at_s, 20);
  EXPECT_EQ(result.faults[1].observed_s, 45);
  ASSERT_THAT(result.violations, SizeIs(1));
  EXPECT_EQ(result.violations[0].time_s, 45);
  EXPECT_EQ(result.violations[0].fault, "deaf#0");
  seen_.courses[1] = {};
  EXPECT_FALSE(Judged().faults[1].observed_s);
}

TEST_F(SoakVerdictTest, OneThatEndsBeforeItsLastFaultHasNotHealed) {
  seen_.faults_outlasted_it = true;
  EXPECT_EQ(Judged().violations.at(0).invariant, "healing");
}

TEST_F(SoakVerdictTest, TellsOfABrokenInvariantWithTheFaultBehindIt) {
  seen_.broken = {{12, {sim::Invariant::kContact, Tick{240}, kOne, kTwo}}};
  seen_.broken_counted = 3;
  const SoakResult result = Judged();
  EXPECT_EQ(result.verdict, SoakVerdict::kFailed);
  EXPECT_EQ(result.violations.at(0).invariant, "contact");
  EXPECT_EQ(result.violations.at(0).fault, "die#0");
  EXPECT_EQ(result.violations_counted, 3U);
}

TEST_F(SoakVerdictTest, FailsWhereAProcessEndedByItself) {
  seen_.ends = {{12, MemberOf(kTwo), "exit code 1", {"why"}}};
  seen_.restarts = 1;
  EXPECT_EQ(Judged().violations.at(0).invariant, "process_ended");
  EXPECT_EQ(Judged().violations.at(0).vehicle, kTwo);
  seen_.ends[0].member = {MemberKind::kDiscoveryServer, Number(kTwo)};
  EXPECT_EQ(Judged().violations.at(0).vehicle, kNoVehicle);
}

TEST_F(SoakVerdictTest, CountsTheEndsThatAreNotListed) {
  seen_.restarts = 300;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kFailed);
  EXPECT_EQ(Judged().violations_counted, 300U);
}

TEST_F(SoakVerdictTest, ExpectsNoDetectionWhereEveryPeerWasSilencedItself) {
  Noticed().reset();
  fleet_ = {kOne, kTwo};
  EXPECT_EQ(Judged().verdict, SoakVerdict::kFailed);
  faults::Fault pause;
  pause.kind = faults::Kind::kPause;
  pause.at_s = 9;
  pause.for_s = 3;
  pause.target.vehicle = kTwo;
  schedule_.insert(schedule_.begin(), pause);
  const FaultCourse paused{.began = seconds(9), .ended = seconds(12), .effect = "it stands"};
  seen_.courses.insert(seen_.courses.begin(), paused);
  seen_.courses[0].recovered = seconds(13);
  seen_.courses[0].noticed = seen_.courses[1].noticed;
  seen_.courses[0].noticed[static_cast<std::size_t>(Mechanism::kDeadline)] = milliseconds(9150);
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed);
  EXPECT_FALSE(Judged().faults[1].promised_s);
  fleet_.push_back(VehicleId{3});
  EXPECT_EQ(Judged().violations.at(0).invariant, "detection") << "vehicle 3 heard it";
}

TEST_F(SoakVerdictTest, ExpectsNoDetectionOfAVehicleThatWasCutOffAlready) {
  Noticed().reset();
  fleet_ = {kOne, kTwo, VehicleId{3}};
  faults::Fault cut;
  cut.kind = faults::Kind::kPartition;
  cut.at_s = 5;
  cut.for_s = 10;
  cut.target.vehicle = kOne;
  schedule_.insert(schedule_.begin(), cut);
  seen_.courses.insert(seen_.courses.begin(),
                       FaultCourse{.began = seconds(5), .ended = seconds(15), .effect = "cut"});
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed);
}

TEST_F(SoakVerdictTest, FailsWhereAProcessGrows) {
  seen_.slopes = {{.process = "vehicle-2", .slope = {1e6, 9e5, 1.1e6, 100, 600}, .leak = true}};
  EXPECT_EQ(Judged().violations.at(0).invariant, "leak");
}

TEST_F(SoakVerdictTest, SaysWhatTheSupervisorTakes) {
  EXPECT_FALSE(Judged().supervisor_cpu_share);
  seen_.supervisor_cpu_share = 0.07;
  EXPECT_EQ(Judged().supervisor_cpu_share, 0.07);
}

TEST_F(SoakVerdictTest, FailsWhereABrainTakesLongerThanItMay) {
  seen_.step_p99_us = {{kOne, 9'000}, {kTwo, 11'000}};
  EXPECT_EQ(Judged().violations.at(0).invariant, "slow_loop");
  EXPECT_EQ(Judged().violations.at(0).vehicle, kTwo);
}

TEST_F(SoakVerdictTest, GivesNoneWhereTheMachineWasTooBusyOrTheFleetNeverDrove) {
  seen_.pauses.share = 0.021;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kNotRun);
  EXPECT_EQ(Judged().reasons.at(0), "machine_too_busy");
  seen_.pauses.share = 0.02;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed);
  seen_.started = false;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kNotRun);
}

TEST_F(SoakVerdictTest, SaysThatItWasInterruptedAndFailsIfSomethingHadBrokenBefore) {
  seen_.interrupted = true;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kInterrupted);
  seen_.courses[0].effect.clear();
  EXPECT_EQ(Judged().verdict, SoakVerdict::kFailed);
}

// Ctrl-C made FAILED of INTERRUPTED: the order of the fault had no time to take effect.
TEST_F(SoakVerdictTest, AFaultThatAnInterruptCutsOffIsNotMissed) {
  seen_.interrupted = true;
  seen_.courses[0].effect.clear();
  Noticed().reset();
  seen_.lasted_s = 10.1;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kInterrupted) << "killed just before";
  seen_.lasted_s = 20.1;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kFailed);
  schedule_[0].kind = faults::Kind::kPause;
  schedule_[0].for_s = 20;
  seen_.courses[0].ended = seconds(30);
  seen_.lasted_s = 30.1;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kInterrupted) << "ended just before";
  seen_.lasted_s = 60;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kFailed);
  seen_.interrupted = false;
  seen_.courses[0].cut_off = true;
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed) << "the soak ended before it";
}

TEST_F(SoakVerdictTest, JudgesOneThatIsShorterThanItsTurn) {
  schedule_[0].kind = faults::Kind::kLoss;
  schedule_[0].for_s = 0.2;
  seen_.courses[0].effect.clear();
  seen_.courses[0].ended = seen_.courses[0].began;
  ASSERT_THAT(Judged().violations, SizeIs(1));
  EXPECT_EQ(Judged().violations[0].invariant, "effect");
}

// Of a pause of 0.8 s that started 0.5 s late too little was left to be noticed.
TEST_F(SoakVerdictTest, LeavesOutOneThatStartedTooLateToLast) {
  schedule_[0].kind = faults::Kind::kLoss;
  schedule_[0].for_s = 0.8;
  seen_.courses[0].effect.clear();
  const SteadyTime planned = seen_.started_at + FromSeconds(schedule_[0].at_s);
  seen_.courses[0].ended = planned + FromSeconds(0.8);
  seen_.courses[0].began = planned + FromSeconds(0.05);
  EXPECT_THAT(Judged().violations, SizeIs(1));
  seen_.courses[0].began = planned + FromSeconds(0.5);
  EXPECT_THAT(Judged().violations, IsEmpty());
}

// It had had its effect, and the vehicle drove on with the other set.
TEST_F(SoakVerdictTest, FailsWhereAFaultWasNotTakenBack) {
  seen_.courses[0].failure = "the order back ended with exit code 1: no answer";
  EXPECT_EQ(Judged().verdict, SoakVerdict::kPassed);
  seen_.courses[0].not_undone = true;
  const SoakResult result = Judged();
  EXPECT_EQ(result.verdict, SoakVerdict::kFailed);
  ASSERT_THAT(result.violations, SizeIs(1));
  EXPECT_EQ(result.violations[0].invariant, "not_undone");
  EXPECT_THAT(result.violations[0].words, HasSubstr("no answer"));
}

TEST_F(SoakVerdictTest, CountsThePlannedRestartsThatCame) {
  schedule_[0].kind = faults::Kind::kRestart;
  schedule_.push_back(schedule_[0]);
  seen_.courses.push_back({});
  EXPECT_EQ(Judged().restarts_planned, 1U);
}

TEST(ExpectedOf, IsASilenceThatLastsLongerThanItsPromise) {
  Limits limits;
  limits.beacon_period = milliseconds(50);
  limits.deadline = milliseconds(150);
  faults::Fault fault;
  fault.kind = faults::Kind::kPause;
  fault.target.vehicle = kOne;
  fault.for_s = 0.2;
  EXPECT_THAT(ExpectedOf(fault, limits), IsEmpty());
  fault.for_s = 2;
  EXPECT_THAT(ExpectedOf(fault, limits), SizeIs(1)) << "liveliness is off in this set";
  limits.liveliness = milliseconds(300);
  EXPECT_THAT(ExpectedOf(fault, limits), SizeIs(2));
  fault.kind = faults::Kind::kLoss;
  EXPECT_THAT(ExpectedOf(fault, limits), IsEmpty());
  fault.kind = faults::Kind::kPause;
  fault.target.what = faults::Target::What::kWorld;
  EXPECT_THAT(ExpectedOf(fault, limits), IsEmpty());
}

}  // namespace
}  // namespace giveway::fleetctl
