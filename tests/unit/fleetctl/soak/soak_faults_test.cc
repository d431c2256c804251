// Which lists of faults a soak carries out.
#include "services/fleetctl/soak/verb/soak_faults.h"

#include <gmock/gmock.h>

#include <vector>

#include "services/config/problem.h"
#include "services/faults/channel.h"

namespace giveway::fleetctl {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

faults::FaultFile Own(const std::string& rule) {
  faults::FaultFile own{.name = "mine.textproto"};
  own.at.push_back({.name = rule, .time_s = 20, .target = {.vehicle = VehicleId{1}}, .line = 3});
  return own;
}

SoakFaults With(const std::string& flag, const std::optional<faults::FaultFile>& own) {
  SoakOptions options;
  options.scenario = "mine";
  options.faults = flag;
  return FaultsOf(options, own);
}

TEST(SoakFaults, AreThoseOfCalmWhereNothingIsSaid) {
  const SoakFaults faults = With("", std::nullopt);
  ASSERT_THAT(faults.sources, SizeIs(1));
  EXPECT_THAT(faults.sources[0].random, testing::Not(IsEmpty()));
  EXPECT_EQ(faults.flag, "calm");
  EXPECT_EQ(faults.name, "calm");
}

TEST(SoakFaults, AreTheScenariosAloneWithoutTheFlag) {
  const SoakFaults faults = With("", Own("a"));
  ASSERT_THAT(faults.sources, SizeIs(1));
  EXPECT_EQ(faults.sources[0].name, "mine.textproto");
  EXPECT_EQ(faults.flag, "");
  EXPECT_EQ(faults.name, "mine");
}

TEST(SoakFaults, AreBothWithTheFlag) {
  const SoakFaults faults = With("everything", Own("a"));
  EXPECT_THAT(faults.sources, SizeIs(2));
  EXPECT_EQ(faults.flag, "everything");
  EXPECT_EQ(faults.name, "mine and everything");
  EXPECT_EQ(With("everything", std::nullopt).name, "everything");
}

TEST(SoakFaults, WithOneNameAreRefused) {
  const std::string name = With("calm", std::nullopt).sources[0].random[0].name;
  EXPECT_THROW(With("calm", Own(name)), InputError);
}

faults::Fault Step(std::uint32_t nth, double at_s) {
  faults::Fault fault;
  fault.rule = "steps";
  fault.nth = nth;
  fault.kind = faults::Kind::kClockStep;
  fault.target.vehicle = VehicleId{3};
  fault.at_s = at_s;
  return fault;
}

// As `fleetctl run` has it: the scenario's own rules were dropped for a vehicle that a fault meets.
TEST(SoakFaults, OfWhatIsHeardComeAfterTheScenariosOwnRules) {
  Impairment own;
  own.seed = 7;
  own.rules.push_back({.loss = 0.1});
  faults::Fault loss = Step(0, 20);
  loss.kind = faults::Kind::kLoss;
  loss.for_s = 5;
  const std::vector<VehicleId> fleet = {VehicleId{3}, VehicleId{4}};
  const auto heard = faults::ImpairmentWith({loss}, fleet, own);
  ASSERT_THAT(heard, SizeIs(2));
  const Impairment& met = heard.at(VehicleId{3});
  ASSERT_THAT(met.rules, SizeIs(2));
  EXPECT_EQ(met.rules[0], own.rules[0]);
  EXPECT_EQ(met.rules[1].from_s, 20);
  EXPECT_EQ(met.seed, 7U);
  EXPECT_EQ(heard.at(VehicleId{4}), own);
  EXPECT_THAT(faults::ImpairmentWith({loss}, fleet, {}).at(VehicleId{4}).rules, IsEmpty());
  EXPECT_THAT(faults::ImpairmentWith({}, fleet, own), IsEmpty());
}

// A soak of 30 days had a line for each, and wrote a report too large to be read again.
TEST(SoakFaults, ThatAreSkippedHaveALineForEachKindAndReason) {
  SkippedFaults skipped;
  EXPECT_THAT(skipped.Lines(), IsEmpty());
  for (std::uint32_t nth = 0; nth < 100'000; ++nth) skipped.Add(Step(nth, nth), "no library");
  skipped.Add(Step(7, 3), "no target");
  EXPECT_EQ(skipped.Count(), 100'001U);
  EXPECT_THAT(skipped.Lines(),
              ElementsAre("steps#0 (clock_step of vehicle 3 at 0.0 s) and 99999 more of its kind: "
                          "no library",
                          "steps#7 (clock_step of vehicle 3 at 3.0 s): no target"));
}

}  // namespace
}  // namespace giveway::fleetctl
