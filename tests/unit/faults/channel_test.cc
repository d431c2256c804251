// Faults of receivers as rules of an impairment.
#include "services/faults/channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/faults/fault_lists.h"

namespace giveway::faults {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};
constexpr VehicleId kThree{3};

std::vector<ImpairmentRule> RulesOf(const Schedule& schedule, VehicleId hearer) {
  const auto impairments = ImpairmentOf(schedule, Fleet(3));
  const auto found = impairments.find(hearer);
  return found == impairments.end() ? std::vector<ImpairmentRule>{} : found->second.rules;
}

ImpairmentRule During(double from_s, double to_s) {
  ImpairmentRule rule{.from = ImpairedSender::kVehicles};
  rule.from_s = from_s;
  rule.to_s = to_s;
  return rule;
}

// Nothing is received from `from`; kNoVehicle: from no vehicle.
ImpairmentRule Deaf(double from_s, double to_s, VehicleId from = kNoVehicle) {
  ImpairmentRule rule = During(from_s, to_s);
  rule.blackouts = {{from_s, to_s}};
  if (from == kNoVehicle) return rule;
  rule.from = ImpairedSender::kOneVehicle;
  rule.from_vehicle = from;
  return rule;
}

TEST(ChannelOfFaults, OnlyHearersFaultsImpairAndOnlyTheirTargets) {
  EXPECT_THAT(ImpairmentOf({Of(Kind::kPause, Vehicle(1), 1, 1)}, Fleet(3)), IsEmpty());
  EXPECT_THAT(ImpairmentOf({Of(Kind::kLoss, Vehicle(2), 1, 1)}, Fleet(3)), SizeIs(1));
  EXPECT_THAT(ImpairmentOf({Of(Kind::kLoss, kAllTarget, 1, 1)}, Fleet(3)), SizeIs(3));
}

TEST(ChannelOfFaults, EachKindIsItsPartOfARule) {
  const auto one = [](Kind kind, Parameters parameters) {
    return RulesOf({Of(kind, Vehicle(1), 10, 5, std::move(parameters))}, kOne);
  };
  ImpairmentRule rule = During(10, 15);
  rule.loss = 0.4;
  EXPECT_THAT(one(Kind::kLoss, {.probability = 0.4}), ElementsAre(rule));
  rule = During(10, 15);
  rule.burst = 0.3;
  rule.burst_length = 20;
  EXPECT_THAT(one(Kind::kBurst, {.probability = 0.3, .count = 20}), ElementsAre(rule));
  rule = During(10, 15);
  rule.delay_s = 0.06;
  EXPECT_THAT(one(Kind::kDelay, {.delay_s = 0.06}), ElementsAre(rule));
  rule = During(10, 15);
  rule.reorder = 0.2;
  rule.reorder_by_s = 0.03;
  EXPECT_THAT(one(Kind::kReorder, {.probability = 0.2, .delay_s = 0.03}), ElementsAre(rule));
  rule = During(10, 15);
  rule.duplicate = 0.5;
  EXPECT_THAT(one(Kind::kDuplicate, {.probability = 0.5}), ElementsAre(rule));
  rule = During(10, 15);
  rule.corrupt = 0.125;
  EXPECT_THAT(one(Kind::kCorrupt, {.probability = 0.125}), ElementsAre(rule));
  rule = During(10, 15);
  rule.rate_bytes_s = 4000;
  EXPECT_THAT(one(Kind::kRate, {.bytes = 4000}), ElementsAre(rule));
  EXPECT_THAT(one(Kind::kOneWayCut, {}), ElementsAre(Deaf(10, 15)));
}

TEST(ChannelOfFaults, OfTwoAtOnceBothCount) {
  const auto rules =
      RulesOf({Of(Kind::kLoss, Vehicle(1), 10, 10), Of(Kind::kDelay, Vehicle(1), 15, 10)}, kOne);
  ImpairmentRule lost = During(10, 15);
  lost.loss = 0.2;
  ImpairmentRule both = During(15, 20);
  both.loss = 0.2;
  both.delay_s = 0.05;
  ImpairmentRule late = During(20, 25);
  late.delay_s = 0.05;
  EXPECT_THAT(rules, ElementsAre(lost, both, late));
}

// The last rule that matches a packet wins, so it must also contain what applies to the others.
TEST(ChannelOfFaults, OneThatIsCutOffAloneIsARuleAfterTheOneForAll) {
  const auto rules = RulesOf({Of(Kind::kLoss, Vehicle(1), 10, 5),
                              Of(Kind::kOneWayCut, Vehicle(1), 10, 5, {.from = kThree})},
                             kOne);
  ImpairmentRule lost = During(10, 15);
  lost.loss = 0.2;
  ImpairmentRule cut = Deaf(10, 15, kThree);
  cut.loss = 0.2;
  EXPECT_THAT(rules, ElementsAre(lost, cut));
}

TEST(ChannelOfFaults, APartitionIsCutBothWays) {
  const Schedule schedule = {Of(Kind::kPartition, Vehicle(1), 10, 5)};
  EXPECT_THAT(RulesOf(schedule, kOne), ElementsAre(Deaf(10, 15)));
  EXPECT_THAT(RulesOf(schedule, kTwo), ElementsAre(Deaf(10, 15, kOne)));
  const Schedule all = {Of(Kind::kPartition, kAllTarget, 10, 5)};
  for (const VehicleId hearer : Fleet(3)) {
    EXPECT_THAT(RulesOf(all, hearer), ElementsAre(Deaf(10, 15)));
  }
}

TEST(ChannelOfFaults, AFlappingOneIsCutOffForTheFirstHalfOfEachPeriod) {
  const auto rules = RulesOf({Of(Kind::kFlapping, Vehicle(1), 10, 5, {.period_s = 2})}, kOne);
  ASSERT_THAT(rules, SizeIs(1));
  EXPECT_THAT(rules[0].blackouts,
              ElementsAre(Blackout{10, 11}, Blackout{12, 13}, Blackout{14, 15}));
}

}  // namespace
}  // namespace giveway::faults
