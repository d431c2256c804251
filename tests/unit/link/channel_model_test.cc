// The impaired channel against its configuration, in simulated time. Shares are judged by five
// standard deviations of a binomial share: a correct model is outside once in two million times,
// and the seeds are fixed, so here it never is.
#include "services/link/impairment/channel_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint32_t kPackets = 100'000;
constexpr std::uint32_t kBytes = 200;
constexpr Nanoseconds kApart = milliseconds(5);
const Sender kThree{Sender::Kind::kVehicle, 3};
const Sender kFour{Sender::Kind::kVehicle, 4};
const Sender kWorld{Sender::Kind::kWorld, 0};
const Sender kStranger{Sender::Kind::kUnknown, 1};

Impairment Of(std::vector<ImpairmentRule> rules, std::uint32_t seed = 7) {
  return {.seed = seed, .rules = std::move(rules)};
}

std::vector<PacketFate> Fates(ChannelModel& model, const Sender& sender = kThree,
                              std::uint32_t packets = kPackets) {
  std::vector<PacketFate> fates;
  for (std::uint32_t i = 0; i < packets; ++i) {
    fates.push_back(model.Decide(sender, kBytes, i * kApart));
  }
  return fates;
}

std::vector<PacketFate> FatesOf(const Impairment& impairment, const Sender& sender = kThree,
                                std::uint32_t packets = kPackets) {
  ChannelModel model(impairment);
  return Fates(model, sender, packets);
}

ImpairmentCounters CountersOf(const ImpairmentRule& rule) {
  ChannelModel model(Of({rule}));
  Fates(model);
  return model.Counters();
}

// True if `count` of `of` is a share of `p`, within five standard deviations.
void ExpectShare(std::uint64_t count, double p, std::uint64_t of = kPackets) {
  const auto n = static_cast<double>(of);
  EXPECT_NEAR(static_cast<double>(count) / n, p, 5 * std::sqrt(p * (1 - p) / n));
}

std::vector<bool> Dropped(const std::vector<PacketFate>& fates) {
  std::vector<bool> dropped;
  for (const PacketFate& fate : fates) dropped.push_back(fate.dropped);
  return dropped;
}

TEST(ChannelModel, ARuleThatAsksForNothingLetsEverythingThroughAtOnce) {
  ChannelModel model(Of({{}}));
  for (const PacketFate& fate : Fates(model)) {
    ASSERT_FALSE(fate.dropped || fate.copy_delay || fate.flipped_bit);
    ASSERT_EQ(fate.delay, Nanoseconds{0});
  }
  const ImpairmentCounters counters = model.Counters();
  EXPECT_EQ(counters.packets, kPackets);
  EXPECT_EQ(counters.passed, kPackets);
  EXPECT_EQ(counters.bytes, std::uint64_t{kPackets} * kBytes);
  EXPECT_EQ(counters.passed_bytes, counters.bytes);
  EXPECT_EQ(counters.Dropped() + counters.delayed + counters.reordered, 0U);
}

TEST(ChannelModel, LosesTheShareAskedFor) {
  for (const double loss : {0.01, 0.1, 0.2, 0.5}) {
    const ImpairmentCounters counters = CountersOf({.loss = loss});
    ExpectShare(counters.dropped_loss, loss);
    EXPECT_EQ(counters.packets, counters.passed + counters.Dropped());
  }
  EXPECT_EQ(CountersOf({.loss = 1}).passed, 0U);
}

// Two lost in a row are as likely as two independent losses.
TEST(ChannelModel, RandomLossHasNoMemory) {
  const auto dropped = Dropped(FatesOf(Of({{.loss = 0.2}})));
  std::uint64_t pairs = 0;
  for (std::size_t i = 1; i < dropped.size(); ++i) pairs += dropped[i - 1] && dropped[i] ? 1 : 0;
  ExpectShare(pairs, 0.04);
}

TEST(ChannelModel, DelaysByWhatWasAskedForWithAnEvenJitter) {
  const ImpairmentRule rule{.delay_s = 0.02, .jitter_s = 0.005};
  double sum_ms = 0;
  double squares = 0;
  for (const PacketFate& fate : FatesOf(Of({rule}))) {
    ASSERT_GE(fate.delay, milliseconds(15));
    ASSERT_LE(fate.delay, milliseconds(25));
    const double off_ms = Milliseconds(fate.delay) - 20;
    sum_ms += off_ms;
    squares += off_ms * off_ms;
  }
  // Of a uniform distribution of half width 5 ms: deviation 5 / sqrt(3).
  const double sigma_ms = 5 / std::sqrt(3.0);
  EXPECT_NEAR(sum_ms / kPackets, 0, 5 * sigma_ms / std::sqrt(double{kPackets}));
  EXPECT_NEAR(std::sqrt(squares / kPackets), sigma_ms, 0.01 * sigma_ms);
}

TEST(ChannelModel, ADelayWithoutJitterIsExact) {
  for (const PacketFate& fate : FatesOf(Of({{.delay_s = 0.02}}), kThree, 1000)) {
    ASSERT_EQ(fate.delay, milliseconds(20));
  }
}

TEST(ChannelModel, BurstsLastAsLongAndTakeAsMuchAsWasAskedFor) {
  const auto dropped = Dropped(FatesOf(Of({{.burst = 0.1, .burst_length = 8}})));
  std::uint64_t lost = 0;
  std::uint64_t bursts = 0;
  for (std::size_t i = 0; i < dropped.size(); ++i) {
    lost += dropped[i] ? 1 : 0;
    bursts += dropped[i] && (i == 0 || !dropped[i - 1]) ? 1 : 0;
  }
  // About 1250 bursts with a geometric length of mean 8: its deviation is 7.5, of the mean 0.21.
  EXPECT_NEAR(static_cast<double>(lost) / static_cast<double>(bursts), 8, 5 * 0.22);
  // Packets of a burst are not independent: the share spreads wider by sqrt((2 * 8) - 1).
  EXPECT_NEAR(static_cast<double>(lost) / kPackets, 0.1, 5 * std::sqrt(15 * 0.1 * 0.9 / kPackets));
}

TEST(ChannelModel, ABadTimeMayLetSomeThrough) {
  const ImpairmentCounters counters =
      CountersOf({.burst = 0.5, .burst_length = 2, .burst_loss = 0.4});
  EXPECT_NEAR(static_cast<double>(counters.dropped_burst) / kPackets, 0.2, 0.01);
  EXPECT_EQ(counters.dropped_loss, 0U);
}

TEST(ChannelModel, DoublesAndSpoilsTheSharesAskedFor) {
  ChannelModel model(Of({{.duplicate = 0.05, .corrupt = 0.02}}));
  std::uint64_t copies = 0;
  std::uint64_t spoilt = 0;
  std::uint64_t in_first_half = 0;
  for (const PacketFate& fate : Fates(model)) {
    copies += fate.copy_delay ? 1 : 0;
    if (!fate.flipped_bit) continue;
    ++spoilt;
    ASSERT_LT(*fate.flipped_bit, 8 * kBytes);
    in_first_half += *fate.flipped_bit < 4 * kBytes ? 1 : 0;
  }
  ExpectShare(copies, 0.05);
  ExpectShare(spoilt, 0.02);
  ExpectShare(in_first_half, 0.5, spoilt);
  EXPECT_EQ(model.Counters().duplicated, copies);
  EXPECT_EQ(model.Counters().corrupted, spoilt);
}

TEST(ChannelModel, WhatIsHeldBackIsOvertaken) {
  ChannelModel model(Of({{.delay_s = 0.01, .reorder = 0.1, .reorder_by_s = 0.012}}));
  const auto fates = Fates(model);
  std::uint64_t held = 0;
  std::uint64_t overtaking = 0;  // due before an earlier one; 12 ms are two packets and a bit
  for (std::size_t i = 0; i < fates.size(); ++i) {
    const bool is_held = fates[i].delay > milliseconds(10);
    held += is_held ? 1 : 0;
    const auto overtakes = [&](std::size_t back) {
      return i >= back && fates[i - back].delay > milliseconds(10);
    };
    overtaking += !is_held && (overtakes(1) || overtakes(2)) ? 1 : 0;
  }
  ExpectShare(held, 0.1);
  EXPECT_EQ(model.Counters().held_back, held);
  EXPECT_EQ(model.Counters().reordered, overtaking);
}

TEST(ChannelModel, ALimitedRatePassesThatRateAndABurstAtOnce) {
  // 200 bytes every 5 ms are 40 000 bytes a second; a quarter of it is let through.
  const ImpairmentRule rule{.rate_bytes_s = 10'000, .rate_burst_bytes = 2000};
  ChannelModel model(Of({rule}));
  const auto fates = Fates(model);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_FALSE(fates[i].dropped) << i;
  const double duration_s = Seconds(kPackets * kApart);
  EXPECT_NEAR(static_cast<double>(model.Counters().passed_bytes), 2000 + 10'000 * duration_s, 250);
  EXPECT_EQ(model.Counters().dropped_rate, kPackets - model.Counters().passed);
  EXPECT_EQ(model.Counters().metered, kPackets);
}

TEST(ChannelModel, APacketBelowALimitedRateIsMeteredAndOneOfABlackoutIsNot) {
  ImpairmentRule rule{.rate_bytes_s = 1e6, .rate_burst_bytes = 2000};
  rule.blackouts = {{1, 2}};
  ChannelModel model(Of({rule}));
  model.Start(seconds(0));
  EXPECT_FALSE(model.Decide(kThree, kBytes, milliseconds(500)).dropped);
  EXPECT_TRUE(model.Decide(kThree, kBytes, milliseconds(1500)).dropped);
  EXPECT_EQ(model.Counters().metered, 1U);
  EXPECT_EQ(model.Counters().dropped_rate, 0U);
}

TEST(ChannelModel, APacketLargerThanTheBucketGetsThroughOnceItIsFull) {
  ChannelModel model(Of({{.rate_bytes_s = 1000, .rate_burst_bytes = 100}}));
  EXPECT_FALSE(model.Decide(kThree, 1000, seconds(0)).dropped);
  EXPECT_TRUE(model.Decide(kThree, 1000, milliseconds(900)).dropped);
  EXPECT_FALSE(model.Decide(kThree, 1000, milliseconds(901)).dropped);
}

TEST(ChannelModel, ABlackoutBeginsAndEndsToTheNanosecondAndOnlyAfterTheStart) {
  ImpairmentRule rule;
  rule.blackouts = {{1, 2}, {5, 6}};
  ChannelModel model(Of({rule}));
  const auto heard = [&](Nanoseconds at) { return !model.Decide(kThree, kBytes, at).dropped; };
  EXPECT_TRUE(heard(seconds(1)));  // not started yet
  model.Start(seconds(10));
  model.Start(seconds(11));  // a second start signal moves nothing
  constexpr Nanoseconds kTick{1};
  EXPECT_TRUE(heard(seconds(11) - kTick));
  EXPECT_FALSE(heard(seconds(11)));
  EXPECT_FALSE(heard(seconds(12) - kTick));
  EXPECT_TRUE(heard(seconds(12)));
  EXPECT_FALSE(heard(milliseconds(15'500)));
  EXPECT_TRUE(heard(seconds(16)));
  EXPECT_EQ(model.Counters().dropped_blackout, 3U);
}

TEST(ChannelModel, ARuleWithTimesHoldsFromOneToTheOtherAndNotBeforeTheStart) {
  ImpairmentRule rule{.loss = 1};
  rule.from_s = 1;
  rule.to_s = 2;
  ChannelModel model(Of({rule}));
  const auto heard = [&](Nanoseconds at) { return !model.Decide(kThree, kBytes, at).dropped; };
  constexpr Nanoseconds kTick{1};
  EXPECT_TRUE(heard(milliseconds(1500)));  // not started yet
  model.Start(seconds(10));
  EXPECT_TRUE(heard(seconds(11) - kTick));
  EXPECT_FALSE(heard(seconds(11)));
  EXPECT_FALSE(heard(seconds(12) - kTick));
  EXPECT_TRUE(heard(seconds(12)));
  EXPECT_EQ(model.Counters().dropped_loss, 2U);
}

// Regression: in a soak the rules of a vehicle that restarts counted from when it had joined,
// seconds late: short faults were over when they should have started to act, and others acted while
// the fleet was to heal.
TEST(ChannelModel, OfOneThatRestartsTimesCountFromWhatItIsTold) {
  ImpairmentRule rule{.loss = 1};
  rule.from_s = 1;
  rule.to_s = 2;
  Impairment impairment = Of({rule});
  impairment.started = seconds(10);
  ChannelModel model(impairment);
  const auto heard = [&](Nanoseconds at) { return !model.Decide(kThree, kBytes, at).dropped; };
  EXPECT_TRUE(heard(milliseconds(10'500)));
  EXPECT_FALSE(heard(milliseconds(11'500)));  // it has not joined yet
  model.Start(milliseconds(11'800));
  EXPECT_TRUE(heard(milliseconds(12'500)));
  EXPECT_EQ(model.Started(), SteadyTime(seconds(10)));
}

TEST(ChannelModel, ARuleOpenAtOneEndHoldsFromEverOrForEver) {
  ImpairmentRule until{.loss = 1};
  until.to_s = 1;
  ImpairmentRule from{.loss = 1};
  from.from_s = 2;
  ChannelModel model(Of({until, from}));
  const auto heard = [&](Nanoseconds at) { return !model.Decide(kThree, kBytes, at).dropped; };
  EXPECT_FALSE(heard(seconds(1)));
  model.Start(seconds(10));
  EXPECT_FALSE(heard(milliseconds(10'500)));
  EXPECT_TRUE(heard(milliseconds(11'500)));
  EXPECT_FALSE(heard(seconds(12)));
  EXPECT_FALSE(heard(seconds(100'000)));
}

// Of the rules that hold at that moment, the last that matches wins.
TEST(ChannelModel, ARuleThatHoldsForATimeStandsInFrontOfOneThatHoldsAlways) {
  ImpairmentRule storm{.loss = 1};
  storm.from_s = 1;
  storm.to_s = 2;
  ChannelModel model(Of({{.delay_s = 0.02}, storm}));
  model.Start(seconds(0));
  EXPECT_EQ(model.Decide(kThree, kBytes, milliseconds(500)).delay, milliseconds(20));
  EXPECT_TRUE(model.Decide(kThree, kBytes, milliseconds(1500)).dropped);
  EXPECT_EQ(model.Decide(kThree, kBytes, milliseconds(2500)).delay, milliseconds(20));
}

TEST(ChannelModel, WhenARuleBeginsMovesNothingOfLaterPackets) {
  const auto late_half = [](double from_s) {
    ImpairmentRule rule{.loss = 0.3};
    rule.from_s = from_s;
    ChannelModel model(Of({rule}));
    model.Decide(kThree, kBytes, seconds(0));
    model.Start(seconds(0));
    std::vector<bool> dropped = Dropped(Fates(model, kThree, 2000));  // 10 s
    dropped.erase(dropped.begin(), dropped.begin() + 1000);
    return dropped;
  };
  EXPECT_EQ(late_half(1), late_half(4));
  EXPECT_THAT(late_half(1), ::testing::Contains(true));
}

TEST(ChannelModel, ABucketIsFullWhenItsRuleBegins) {
  ImpairmentRule rule{.rate_bytes_s = 1, .rate_burst_bytes = 3 * kBytes};
  rule.from_s = 5;
  ChannelModel model(Of({rule}));
  model.Start(seconds(0));
  EXPECT_FALSE(model.Decide(kThree, kBytes, seconds(1)).dropped);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(model.Decide(kThree, kBytes, seconds(6)).dropped) << i;
  EXPECT_TRUE(model.Decide(kThree, kBytes, seconds(6)).dropped);
}

bool SameFate(const PacketFate& a, const PacketFate& b) {
  return a.dropped == b.dropped && a.delay == b.delay && a.copy_delay == b.copy_delay &&
         a.flipped_bit == b.flipped_bit;
}

const ImpairmentRule kEverything{.loss = 0.1,
                                 .burst = 0.05,
                                 .delay_s = 0.02,
                                 .jitter_s = 0.01,
                                 .reorder = 0.1,
                                 .duplicate = 0.1,
                                 .corrupt = 0.1};

TEST(ChannelModel, TheSameSeedDecidesTheSame) {
  const auto first = FatesOf(Of({kEverything}), kThree, 5000);
  const auto again = FatesOf(Of({kEverything}), kThree, 5000);
  for (std::size_t i = 0; i < first.size(); ++i) ASSERT_TRUE(SameFate(first[i], again[i])) << i;
  EXPECT_NE(Dropped(first), Dropped(FatesOf(Of({kEverything}, 8), kThree, 5000)));
}

TEST(ChannelModel, WhatOneSenderSaysMovesNothingOfAnother) {
  ChannelModel model(Of({kEverything}));
  const auto alone = FatesOf(Of({kEverything}), kThree, 5000);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const SteadyTime now = static_cast<std::int64_t>(i) * kApart;
    const PacketFate fate = model.Decide(kThree, kBytes, now);
    model.Decide(kFour, kBytes, now);
    ASSERT_TRUE(SameFate(fate, alone[i])) << i;
  }
  EXPECT_NE(Dropped(alone), Dropped(FatesOf(Of({kEverything}), kFour, 5000)));
}

TEST(ChannelModel, EachHearerLosesPacketsOfItsOwn) {
  ChannelModel one(Of({{.loss = 0.2}}));
  ChannelModel two(Of({{.loss = 0.2}}));
  one.NameHearer(VehicleId{1});
  two.NameHearer(VehicleId{2});
  const auto by_one = Dropped(Fates(one));
  const auto by_two = Dropped(Fates(two));
  std::uint64_t by_both = 0;
  for (std::size_t i = 0; i < kPackets; ++i) by_both += by_one[i] && by_two[i] ? 1 : 0;
  ExpectShare(by_both, 0.04);
}

TEST(ChannelModel, AskingForDelayDoesNotChangeWhoIsLost) {
  ImpairmentRule late = kEverything;
  late.delay_s = 0.3;
  late.corrupt = 0;
  EXPECT_EQ(Dropped(FatesOf(Of({kEverything}))), Dropped(FatesOf(Of({late}))));
}

TEST(ChannelModel, OfTheRulesThatFitTheLastCounts) {
  const ImpairmentRule deaf_to_vehicles{.from = ImpairedSender::kVehicles, .loss = 1};
  const ImpairmentRule but_not_to_four{.from = ImpairedSender::kOneVehicle,
                                       .from_vehicle = VehicleId{4}};
  ChannelModel model(Of({deaf_to_vehicles, but_not_to_four}));
  const auto heard = [&](const Sender& sender) {
    return !model.Decide(sender, kBytes, seconds(1)).dropped;
  };
  EXPECT_FALSE(heard(kThree));
  EXPECT_TRUE(heard(kFour));
  EXPECT_TRUE(heard(kWorld));
  EXPECT_TRUE(heard(kStranger));
  ChannelModel other_way_round(Of({but_not_to_four, deaf_to_vehicles}));
  EXPECT_TRUE(other_way_round.Decide(kFour, kBytes, seconds(1)).dropped);
}

TEST(ChannelModel, ARuleForTheWorldLeavesVehiclesAlone) {
  ChannelModel model(Of({{.from = ImpairedSender::kWorld, .loss = 1}}));
  EXPECT_TRUE(model.Decide(kWorld, kBytes, seconds(1)).dropped);
  EXPECT_FALSE(model.Decide(kThree, kBytes, seconds(1)).dropped);
  EXPECT_EQ(model.CountersOf(kWorld).dropped_loss, 1U);
  EXPECT_EQ(model.CountersOf(kThree).passed, 1U);
  EXPECT_EQ(model.CountersOf(kFour).packets, 0U);
}

TEST(ChannelModel, ARuleForOneHearerAppliesOnceItIsKnownWhoHears) {
  const Impairment impairment = Of({{.to_vehicle = VehicleId{2}, .loss = 1}});
  ChannelModel two(impairment);
  EXPECT_FALSE(two.Decide(kThree, kBytes, seconds(1)).dropped);
  two.NameHearer(VehicleId{2});
  EXPECT_TRUE(two.Decide(kThree, kBytes, seconds(2)).dropped);
  EXPECT_EQ(two.Counters().packets, 2U);
  ChannelModel five(impairment);
  five.NameHearer(VehicleId{5});
  EXPECT_FALSE(five.Decide(kThree, kBytes, seconds(2)).dropped);
}

}  // namespace
}  // namespace giveway::link
