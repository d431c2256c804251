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
    EvaluateSoak({seen_, schedule_, limits_, [this](SteadyTime, SteadyTime) { return pause_; },
                  true, fleet_},
                 &result);
    return result;
  }

  faults::Schedule schedule_;
  SoakSeen seen_;
  Limits limits_;
  Nanoseconds pause_{0};
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
  pause_ = seconds(5);
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
