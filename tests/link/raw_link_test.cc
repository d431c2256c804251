// What a recorder hears: the bytes that came, of every vehicle, with both times.
#include "services/link/raw_link.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "services/link/fastdds/topics.h"
#include "services/link/sample_codec.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

constexpr std::size_t kBeacons = 0;  // of RawTopics()

TEST(RawLink, HearsTheBeaconsOfAllVehiclesAsTheyWereSerialized) {
  ASSERT_EQ(link::RawTopics()[kBeacons].name, "fleet/beacon");
  const DomainLock domain;
  Beaconing seven(OptionsIn(domain), VehicleId{7});
  Beaconing eight(OptionsIn(domain), VehicleId{8});
  link::RawLink recorder(OptionsIn(domain), {kBeacons});
  std::map<std::uint32_t, link::RawSample> heard;
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    eight.Send();
    recorder.Take([&](link::RawSample sample) {
      link::Observed observed;
      ASSERT_EQ(link::DecodeInto("fleet/beacon", sample.bytes, &observed), link::Decoded::kYes);
      ASSERT_TRUE(observed.beacons.front().crc_valid);
      heard[Number(observed.beacons.front().beacon.vehicle)] = std::move(sample);
    });
    return heard.size() == 2;
  }));
  const link::RawSample& sample = heard.at(7);
  EXPECT_EQ(sample.topic, kBeacons);
  EXPECT_GT(sample.source_ns, 1'600'000'000'000'000'000U);
  EXPECT_GE(sample.reception_ns, sample.source_ns);
  EXPECT_GT(sample.sequence, 0U);
}

// Bursts that its history holds, each taken before the next is sent: the reader may be late on a
// busy machine, and keeps the newest.
TEST(RawLink, OfOneVehicleEverySampleComesInOrder) {
  constexpr std::size_t kBurst = 8;
  const DomainLock domain;
  Beaconing sender(OptionsIn(domain), VehicleId{7});
  link::RawLink recorder(OptionsIn(domain), {kBeacons});
  std::vector<std::uint32_t> seqs;
  const auto take = [&] {
    recorder.Take([&](const link::RawSample& sample) {
      link::Observed observed;
      link::DecodeInto("fleet/beacon", sample.bytes, &observed);
      seqs.push_back(observed.beacons.front().beacon.seq);
    });
  };
  const auto heard_all = [&] {
    return Eventually([&] {
      take();
      return seqs.back() == sender.Seq();
    });
  };
  ASSERT_TRUE(Eventually([&] {
    sender.Send();
    take();
    return !seqs.empty();
  }));
  ASSERT_TRUE(heard_all());
  seqs = {seqs.back()};
  while (seqs.size() < 200) {
    for (std::size_t i = 0; i < kBurst; ++i) sender.Send();
    ASSERT_TRUE(heard_all()) << seqs.back() << " of " << sender.Seq();
  }
  for (std::size_t i = 1; i < seqs.size(); ++i) EXPECT_EQ(seqs[i], seqs[i - 1] + 1);
}

TEST(RawLink, SaysWhatItsReadersAskFor) {
  const DomainLock domain;
  const link::RawLink recorder(OptionsIn(domain), {kBeacons});
  EXPECT_EQ(recorder.QosText(kBeacons), "BEST_EFFORT, VOLATILE, deadline 150 ms");
}

TEST(RawLink, ReadsWhatIsOpenedLater) {
  const DomainLock domain;
  Beaconing seven(OptionsIn(domain), VehicleId{7});
  link::RawLink recorder(OptionsIn(domain), {});
  EXPECT_EQ(recorder.QosText(kBeacons), "");
  recorder.Open(kBeacons);
  recorder.Open(kBeacons);
  std::set<std::uint32_t> sequences;
  std::size_t heard = 0;
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    recorder.Take([&](const link::RawSample& sample) {
      ++heard;
      sequences.insert(sample.sequence);
    });
    return heard > 20;
  }));
  EXPECT_EQ(sequences.size(), heard);  // each once
}

TEST(RawLink, TheSamplesOfAVehicleAreOneInstance) {
  const DomainLock domain;
  Beaconing seven(OptionsIn(domain), VehicleId{7});
  Beaconing eight(OptionsIn(domain), VehicleId{8});
  link::RawLink recorder(OptionsIn(domain), {kBeacons});
  std::map<std::uint32_t, std::set<std::array<std::uint8_t, 16>>> instances;
  std::size_t heard = 0;
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    eight.Send();
    recorder.Take([&](const link::RawSample& sample) {
      link::Observed observed;
      link::DecodeInto("fleet/beacon", sample.bytes, &observed);
      instances[Number(observed.beacons.front().beacon.vehicle)].insert(sample.instance);
      ++heard;
    });
    return instances.size() == 2 && heard > 40;
  }));
  ASSERT_EQ(instances[7].size(), 1U);
  ASSERT_EQ(instances[8].size(), 1U);
  EXPECT_NE(*instances[7].begin(), *instances[8].begin());
  EXPECT_TRUE(link::RawTopics()[kBeacons].keyed);
}

TEST(RawLink, SaysWhichTopicsAreKeptForReadersThatComeLate) {
  const DomainLock domain;
  const auto& topics = link::RawTopics();
  const auto place = [&](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(topics, name, &link::RawTopic::name) -
                                    topics.begin());
  };
  const link::RawLink recorder(OptionsIn(domain),
                               {kBeacons, place("world/roster"), place("world/event")});
  EXPECT_FALSE(recorder.IsDurable(kBeacons));
  EXPECT_TRUE(recorder.IsDurable(place("world/roster")));
  EXPECT_FALSE(recorder.IsDurable(place("world/signal")));  // not read
  EXPECT_FALSE(topics[place("world/event")].keyed);
}

// Where clients come and go, it is made and destroyed while writers write: the library is said to
// remove readers unsafely.
TEST(RawLink, IsMadeAndEndsAgainAndAgainWhileVehiclesSend) {
  const DomainLock domain;
  const BeaconingProcess seven(OptionsIn(domain), VehicleId{7});
  const BeaconingProcess eight(OptionsIn(domain), VehicleId{8});
  for (int times = 0; times < 12; ++times) {
    link::RawLink recorder(OptionsIn(domain), {});
    for (std::size_t topic = 0; topic < link::RawTopics().size(); ++topic) recorder.Open(topic);
    std::size_t heard = 0;
    ASSERT_TRUE(Eventually([&] {
      recorder.Take([&](const link::RawSample&) { ++heard; });
      return heard > 2;
    }));
  }
}

// Issue 25: pose fixes were in no recording.
TEST(RawLink, KnowsEveryTopicButThoseOfOperators) {
  std::vector<std::string> names;
  for (const link::RawTopic& topic : link::RawTopics()) names.emplace_back(topic.name);
  std::vector<std::string> all;
#define GIVEWAY_ADD_NAME(wire_type, name, profile, key_numbers) all.emplace_back(name);
  GIVEWAY_TOPICS(GIVEWAY_ADD_NAME)
#undef GIVEWAY_ADD_NAME
  EXPECT_EQ(std::erase(all, "fleet/admin") + std::erase(all, "fleet/answer"), 2U);
  EXPECT_THAT(names, ::testing::ElementsAreArray(all));
}

TEST(RawLink, HearsThePoseFixesOfAVehicle) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  RobotModel profile;
  profile.pose_fix.every_s = 0.1;
  ASSERT_TRUE(profile.pose_fix.Fitted());
  world.OpenVehicle(VehicleId{7}, profile);
  const auto& topics = link::RawTopics();
  const auto fixes = std::ranges::find(topics, "world/pose_fix", &link::RawTopic::name);
  ASSERT_NE(fixes, topics.end());
  EXPECT_EQ(fixes->type, "giveway::wire::PoseFix");
  link::RawLink recorder(OptionsIn(domain), {static_cast<std::size_t>(fixes - topics.begin())});
  bool heard = false;
  EXPECT_TRUE(Eventually([&] {
    PoseFix fix;
    fix.vehicle = VehicleId{7};
    world.SendPoseFix(fix);
    recorder.Take([&](const link::RawSample& sample) { heard = !sample.bytes.empty(); });
    return heard;
  }));
}

TEST(SampleCodec, WhatWasEncodedIsDecodedToTheSame) {
  Truth truth;
  truth.vehicle = VehicleId{7};
  truth.time_s = 1.25;
  WorldEvent event;
  event.kind = EventKind::kContact;
  event.text = "text";
  link::Observed observed;
  EXPECT_EQ(link::DecodeInto("world/truth", link::Encode(truth), &observed), link::Decoded::kYes);
  EXPECT_EQ(link::DecodeInto("world/event", link::Encode(event), &observed), link::Decoded::kYes);
  EXPECT_DOUBLE_EQ(observed.truths.front().time_s, 1.25);
  EXPECT_EQ(observed.events.front().text, "text");
}

}  // namespace
}  // namespace giveway::test
