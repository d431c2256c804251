// Rules of the radio that are on for a time: what is cut, lost, late and twice, and when.
#include "sim_world/virtual/radio_rules.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "sim_world/virtual/radio.h"

namespace giveway::sim {
namespace {

constexpr std::array kIds = {VehicleId{1}, VehicleId{2}, VehicleId{3}};
constexpr Nanoseconds kTickPeriod{50'000'000};

// At which of the ticks 0 to 99 vehicle `hearer` (by number) does not hear `speaker`.
std::vector<int> CutTicks(const RadioRule& rule, std::size_t hearer, std::size_t speaker) {
  RadioRules rules(std::array{rule}, kIds, 1, kTickPeriod);
  std::vector<int> cut;
  for (int tick = 0; tick < 100; ++tick) {
    rules.BeginTick(0.05 * tick);
    if (rules.IsCut(hearer, speaker, true)) cut.push_back(tick);
    EXPECT_EQ(rules.Any(), tick >= 20 && tick < 40);
  }
  return cut;
}

std::vector<int> FromTo(int from, int to) {
  std::vector<int> ticks;
  for (int tick = from; tick < to; ++tick) ticks.push_back(tick);
  return ticks;
}

constexpr RadioRule kCut{.from_s = 1, .to_s = 2, .hearer = VehicleId{2}, .cut = true};

TEST(RadioRules, ACutHasActedOnceABeaconWasCutOff) {
  RadioRule rule = kCut;
  rule.draws = 7;
  RadioRules rules(std::array{rule}, kIds, 1, kTickPeriod);
  rules.BeginTick(1.5);
  EXPECT_TRUE(rules.IsCut(1, 2, false));
  EXPECT_FALSE(rules.IsCut(2, 1, true));  // another hears it
  EXPECT_FALSE(rules.HasActed(7));
  EXPECT_TRUE(rules.IsCut(1, 2, true));
  EXPECT_TRUE(rules.HasActed(7));
  EXPECT_FALSE(rules.HasActed(8));
}

TEST(RadioRules, ADelayHasActedOnABeaconThatWasSentMeanwhile) {
  const RadioRule rule{
      .from_s = 1, .to_s = 2, .hearer = VehicleId{2}, .delay = 2 * kTickPeriod, .draws = 7};
  RadioRules rules(std::array{rule}, kIds, 1, kTickPeriod);
  rules.BeginTick(1.0);
  EXPECT_EQ(rules.Of(1, 2, 5, 15).late_ticks, 0U);
  EXPECT_FALSE(rules.HasActed(7));
  EXPECT_EQ(rules.Of(1, 2, 0, 20).late_ticks, 2U);
  EXPECT_TRUE(rules.HasActed(7));
}

TEST(RadioRules, AOneWayCutIsOfOneEarAndOneMouth) {
  RadioRule rule = kCut;
  rule.speaker = VehicleId{3};
  EXPECT_EQ(CutTicks(rule, 1, 2), FromTo(20, 40));
  EXPECT_TRUE(CutTicks(rule, 2, 1).empty());
  EXPECT_TRUE(CutTicks(rule, 1, 0).empty());
}

TEST(RadioRules, APartitionIsOfAllOthersBothWays) {
  RadioRule rule = kCut;
  rule.both_ways = true;
  EXPECT_EQ(CutTicks(rule, 1, 2), FromTo(20, 40));
  EXPECT_EQ(CutTicks(rule, 0, 1), FromTo(20, 40));
  EXPECT_TRUE(CutTicks(rule, 0, 2).empty());
}

TEST(RadioRules, AFlappingOneIsOnForTheFirstHalfOfEachPeriod) {
  RadioRule rule = kCut;
  rule.both_ways = true;
  rule.period_s = 0.5;
  std::vector<int> expected = FromTo(20, 25);
  for (const int tick : FromTo(30, 35)) expected.push_back(tick);
  EXPECT_EQ(CutTicks(rule, 1, 0), expected);
}

// 1000 beacons of vehicle 2 as vehicle 1 receives them, under a rule that is on in the ticks 200 to
// 799: how many come twice, late, or not at all, of those sent while it is on and while it is off.
struct Tally {
  int lost = 0;
  int twice = 0;
  int late = 0;
  int longest_row = 0;  // lost one after the other
};

std::array<Tally, 2> HeardUnder(RadioRule rule, RadioSettings settings = {}) {
  rule.from_s = 10;
  rule.to_s = 40;
  Scenario scenario;
  scenario.vehicles.resize(2);
  scenario.vehicles[0].id = VehicleId{1};
  scenario.vehicles[1].id = VehicleId{2};
  settings.rules = {rule};
  Radio radio(scenario, settings, 1);
  std::vector<RadioPlace> places = {{{0, 0}, true}, {{3, 0}, true}};
  std::vector<int> times(1001);
  std::vector<std::uint32_t> after(1001);
  for (std::uint32_t tick = 1; tick <= 1050; ++tick) {
    radio.BeginTick(Tick{tick}, 0.05 * tick, places);
    std::vector<ReceivedBeacon> heard;
    radio.Hear(0, &heard);
    for (const ReceivedBeacon& received : heard) {
      ++times[received.beacon.seq];
      after[received.beacon.seq] = tick - received.beacon.seq;
    }
    if (tick > 1000) continue;
    Beacon beacon;
    beacon.seq = tick;
    radio.Transmit(1, Tick{tick}, beacon);
  }
  std::array<Tally, 2> tallies;
  int row = 0;
  for (std::uint32_t seq = 1; seq <= 1000; ++seq) {
    Tally& tally = tallies[seq >= 200 && seq < 800 ? 1 : 0];
    tally.lost += times[seq] == 0 ? 1 : 0;
    tally.twice += times[seq] > 1 ? 1 : 0;
    tally.late += after[seq] > 1 ? 1 : 0;
    row = times[seq] == 0 ? row + 1 : 0;
    tally.longest_row = std::max(tally.longest_row, row);
  }
  return tallies;
}

void ExpectNothing(const Tally& tally) {
  EXPECT_EQ(tally.lost, 0);
  EXPECT_EQ(tally.twice, 0);
  EXPECT_EQ(tally.late, 0);
}

TEST(RadioRules, LossIsOfSingleBeaconsSaidUnderTheRule) {
  const auto [without, within] = HeardUnder({.loss = 0.3});
  ExpectNothing(without);
  EXPECT_NEAR(within.lost, 180, 40);
  EXPECT_LT(within.longest_row, 9);
}

TEST(RadioRules, BurstsLoseTheirShareInRows) {
  const auto [without, within] = HeardUnder({.burst_loss = 0.3, .burst_ticks = 10});
  ExpectNothing(without);
  EXPECT_NEAR(within.lost, 180, 90);
  EXPECT_EQ(within.lost % 10, 0);
  EXPECT_GE(within.longest_row, 10);
}

TEST(RadioRules, ADelayIsOfAllThatWasSaidUnderTheRuleAndLosesNothing) {
  const auto [without, within] = HeardUnder({.delay = Nanoseconds(200'000'000)});
  ExpectNothing(without);
  EXPECT_EQ(within.lost, 0);
  EXPECT_EQ(within.twice, 0);
  EXPECT_EQ(within.late, 600);
}

TEST(RadioRules, WhatIsHeldBackIsOvertaken) {
  const auto [without, within] =
      HeardUnder({.reorder = 0.2, .reorder_by = Nanoseconds(75'000'000)});
  ExpectNothing(without);
  EXPECT_EQ(within.lost, 0);
  EXPECT_NEAR(within.late, 120, 40);
}

TEST(RadioRules, DuplicatesComeTwice) {
  const auto [without, within] = HeardUnder({.duplicate = 0.2});
  ExpectNothing(without);
  EXPECT_EQ(within.lost, 0);
  EXPECT_NEAR(within.twice, 120, 40);
}

// A beacon delayed beyond the storage limit arrives by then.
TEST(RadioRules, NothingIsUnderWayForLongerThanItIsKept) {
  const auto [without, within] = HeardUnder({.delay = Nanoseconds(10'000'000'000)});
  ExpectNothing(without);
  EXPECT_EQ(within.lost, 0);
  EXPECT_EQ(within.late, 600);
}

// Of one rule the draws do not hang on whether there is another.
TEST(RadioRules, DrawByTheirOwnNumbers) {
  RadioRules one(std::array{RadioRule{.to_s = 100, .loss = 0.5, .draws = 7}}, kIds, 1, kTickPeriod);
  RadioRules two(std::array{RadioRule{.to_s = 100, .duplicate = 0.5, .draws = 3},
                            RadioRule{.to_s = 100, .loss = 0.5, .draws = 7}},
                 kIds, 1, kTickPeriod);
  for (std::uint32_t tick = 2; tick < 200; ++tick) {
    one.BeginTick(0.05 * tick);
    two.BeginTick(0.05 * tick);
    ASSERT_EQ(one.Of(0, 1, 1, tick - 1).lost, two.Of(0, 1, 1, tick - 1).lost) << tick;
  }
}

}  // namespace
}  // namespace giveway::sim
