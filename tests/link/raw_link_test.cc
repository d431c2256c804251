// What a recorder hears: the bytes that came, of every vehicle, with both times.
#include "services/link/raw_link.h"

#include <gtest/gtest.h>

#include <map>

#include "services/link/sample_codec.h"
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

TEST(RawLink, OfOneVehicleEverySampleComesInOrder) {
  const DomainLock domain;
  Beaconing sender(OptionsIn(domain), VehicleId{7});
  link::RawLink recorder(OptionsIn(domain), {kBeacons});
  std::vector<std::uint32_t> seqs;
  ASSERT_TRUE(Eventually([&] {
    for (int burst = 0; burst < 8; ++burst) sender.Send();
    recorder.Take([&](const link::RawSample& sample) {
      link::Observed observed;
      link::DecodeInto("fleet/beacon", sample.bytes, &observed);
      seqs.push_back(observed.beacons.front().beacon.seq);
    });
    return seqs.size() > 200;
  }));
  for (std::size_t i = 1; i < seqs.size(); ++i) EXPECT_EQ(seqs[i], seqs[i - 1] + 1);
}

TEST(RawLink, SaysWhatItsReadersAskFor) {
  const DomainLock domain;
  const link::RawLink recorder(OptionsIn(domain), {kBeacons});
  EXPECT_EQ(recorder.QosText(kBeacons), "BEST_EFFORT, VOLATILE, deadline 150 ms");
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
