// Subscriptions of one client, and what waits for it: the newest of each vehicle, bounded.
#include "services/observer/foxglove/newest_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "services/observer/capture/fleet_capture.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::size_t Beacons() { return RawTopicNamed("fleet/beacon"); }
std::size_t Truths() { return RawTopicNamed("world/truth"); }
std::size_t Events() { return RawTopicNamed("world/event"); }

SharedSample Of(std::size_t topic, std::uint32_t vehicle, const std::string& bytes) {
  link::RawSample sample{.topic = topic, .bytes = bytes};
  for (std::size_t i = 0; i < 4; ++i) {
    sample.instance[i] = static_cast<std::uint8_t>(vehicle >> (24 - 8 * i));
  }
  return std::make_shared<const link::RawSample>(std::move(sample));
}

std::vector<std::string> All(NewestSamples* samples) {
  std::vector<std::string> all;
  while (const auto due = samples->Take()) {
    all.push_back(std::to_string(due->subscription) + ":" + due->sample->bytes);
  }
  return all;
}

TEST(NewestSamples, OnlyWhatIsSubscribedToIsKept) {
  NewestSamples samples;
  samples.Offer(Of(Beacons(), 1, "a"));
  EXPECT_EQ(samples.Waiting(), 0U);
  EXPECT_EQ(samples.Subscribe(40, Beacons()), "");
  samples.Offer(Of(Beacons(), 1, "b"));
  samples.Offer(Of(Truths(), 1, "c"));
  EXPECT_THAT(All(&samples), ElementsAre("40:b"));
}

TEST(NewestSamples, OfEachVehicleTheNewestWaits) {
  NewestSamples samples;
  samples.Subscribe(1, Beacons());
  for (int n = 0; n < 1000; ++n) {
    samples.Offer(Of(Beacons(), 7, "seven " + std::to_string(n)));
    samples.Offer(Of(Beacons(), 8, "eight " + std::to_string(n)));
  }
  EXPECT_EQ(samples.Waiting(), 2U);
  EXPECT_EQ(samples.Skipped(), 1998U);
  EXPECT_THAT(All(&samples), ElementsAre("1:seven 999", "1:eight 999"));
  EXPECT_FALSE(samples.Take());
}

TEST(NewestSamples, TopicsDoNotReplaceEachOther) {
  NewestSamples samples;
  samples.Subscribe(1, Beacons());
  samples.Subscribe(2, Truths());
  samples.Offer(Of(Beacons(), 7, "beacon"));
  samples.Offer(Of(Truths(), 7, "truth"));
  EXPECT_THAT(All(&samples), ElementsAre("1:beacon", "2:truth"));
}

// A new sample of a vehicle keeps the vehicle's place in the queue: none starves.
TEST(NewestSamples, TheOneThatWaitedLongestIsNext) {
  NewestSamples samples;
  samples.Subscribe(1, Beacons());
  for (std::uint32_t vehicle = 1; vehicle <= 3; ++vehicle) {
    samples.Offer(Of(Beacons(), vehicle, "old " + std::to_string(vehicle)));
  }
  samples.Offer(Of(Beacons(), 1, "new 1"));
  EXPECT_THAT(All(&samples), ElementsAre("1:new 1", "1:old 2", "1:old 3"));
}

TEST(NewestSamples, OfATopicWithoutAKeyTheLastFewWait) {
  NewestSamples samples;
  samples.Subscribe(1, Events());
  samples.Subscribe(2, Beacons());
  samples.Offer(Of(Beacons(), 7, "beacon"));
  samples.Offer(Of(Events(), 0, "first"));
  samples.Offer(Of(Events(), 0, "second"));
  EXPECT_THAT(All(&samples), ElementsAre("2:beacon", "1:first", "1:second"));
  samples.Offer(Of(Beacons(), 7, "beacon"));
  for (std::size_t n = 0; n < NewestSamples::kMostUnkeyed + 10; ++n) {
    samples.Offer(Of(Events(), 0, std::to_string(n)));
  }
  EXPECT_EQ(samples.Waiting(), NewestSamples::kMostUnkeyed + 1);
  const std::vector<std::string> all = All(&samples);
  EXPECT_EQ(all[0], "2:beacon");
  EXPECT_EQ(all[1], "1:10");
}

TEST(NewestSamples, InstancesAreBounded) {
  NewestSamples samples;
  samples.Subscribe(1, Beacons());
  const auto most = static_cast<std::uint32_t>(NewestSamples::kMostInstances);
  for (std::uint32_t vehicle = 1; vehicle <= most + 5; ++vehicle) {
    samples.Offer(Of(Beacons(), vehicle, std::to_string(vehicle)));
  }
  EXPECT_EQ(samples.Waiting(), NewestSamples::kMostInstances);
  EXPECT_EQ(samples.Take()->sample->bytes, "6");
}

TEST(NewestSamples, AfterUnsubscribingNothingIsLeft) {
  NewestSamples samples;
  samples.Subscribe(1, Events());
  samples.Subscribe(2, Beacons());
  samples.Offer(Of(Events(), 0, "event"));
  samples.Offer(Of(Beacons(), 7, "beacon"));
  EXPECT_EQ(samples.Unsubscribe(1), "");
  samples.Offer(Of(Events(), 0, "event"));
  EXPECT_THAT(All(&samples), ElementsAre("2:beacon"));
  EXPECT_FALSE(samples.IsSubscribed(Events()));
  EXPECT_EQ(samples.Subscribe(1, Events()), "");
  for (std::size_t n = 0; n < NewestSamples::kMostUnkeyed; ++n) samples.Offer(Of(Events(), 0, "x"));
  EXPECT_EQ(samples.Waiting(), NewestSamples::kMostUnkeyed);
}

TEST(NewestSamples, WhatCannotBeIsRefusedInWords) {
  NewestSamples samples;
  samples.Subscribe(1, Beacons());
  EXPECT_THAT(samples.Subscribe(1, Truths()), HasSubstr("in use"));
  EXPECT_THAT(samples.Subscribe(2, Beacons()), HasSubstr("fleet/beacon is subscribed to already"));
  EXPECT_THAT(samples.Unsubscribe(2), HasSubstr("no subscription 2"));
  EXPECT_EQ(samples.ByTopic().size(), 1U);
}

TEST(KeptSamples, TheNewestOfEachInstanceIsThereForWhoeverComesLate) {
  KeptSamples kept;
  kept.Keep(Of(Beacons(), 7, "old"));
  kept.Keep(Of(Beacons(), 7, "new"));
  kept.Keep(Of(Truths(), 7, "truth"));
  for (std::size_t n = 0; n < NewestSamples::kMostUnkeyed + 3; ++n) {
    kept.Keep(Of(Events(), 0, std::to_string(n)));
  }
  const auto of = [&kept](std::size_t topic) {
    std::vector<std::string> all;
    kept.ForEach(topic, [&](const SharedSample& sample) { all.push_back(sample->bytes); });
    return all;
  };
  EXPECT_THAT(of(Beacons()), ElementsAre("new"));
  EXPECT_THAT(of(Truths()), ElementsAre("truth"));
  EXPECT_EQ(of(Events()).size(), NewestSamples::kMostUnkeyed);
  EXPECT_EQ(of(Events()).front(), "3");
  kept.Clear();
  EXPECT_TRUE(of(Events()).empty());
}

}  // namespace
}  // namespace giveway
