// What Cyclone DDS hears of our vehicles.
#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <set>

#include "tests/link/fleet.h"
#include "tests/link/foreign/foreign.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;

constexpr VehicleId kSeven{7};

// What our writers offer, asked for as it is.
ForeignQos AsOffered() { return {.partition = "main/*", .deadline_ms = 150, .lease_ms = 250}; }

class ForeignReader : public ::testing::Test {
 protected:
  // True once a sample came of which `is_it` is true; vehicle 7 sends meanwhile.
  bool Hears(dds_entity_t reader, const std::function<bool(const ForeignSample&)>& is_it,
             milliseconds deadline = std::chrono::seconds(60)) {
    return Eventually(
        [&] {
          vehicle_.Send();
          const auto samples = Take(reader);
          return std::ranges::any_of(samples, is_it);
        },
        deadline);
  }
  bool Hears(dds_entity_t reader) {
    return Hears(reader, [](const ForeignSample& sample) { return sample.valid; });
  }
  // That it does not, while another one hears: then discovery is through.
  void ExpectDeaf(const ForeignQos& qos) {
    const dds_entity_t reader = stranger_.MakeReader(qos);
    ASSERT_TRUE(Hears(stranger_.MakeReader(AsOffered())));
    EXPECT_FALSE(Hears(
        reader, [](const ForeignSample& sample) { return sample.valid; }, milliseconds(300)));
    EXPECT_EQ(IncompatiblePolicy(reader), expected_policy_);
  }
  static std::uint32_t IncompatiblePolicy(dds_entity_t reader) {
    dds_requested_incompatible_qos_status_t status{};
    dds_get_requested_incompatible_qos_status(reader, &status);
    return status.total_count == 0 ? 0 : status.last_policy_id;
  }

  DomainLock domain_;
  ForeignParticipant stranger_{domain_.Domain()};
  Beaconing vehicle_{OptionsIn(domain_), kSeven};
  std::uint32_t expected_policy_ = 0;
};

TEST_F(ForeignReader, HearsEveryFieldOfABeacon) {
  const dds_entity_t reader = stranger_.MakeReader(AsOffered());
  std::vector<ForeignSample> got;
  ASSERT_TRUE(Eventually([&] {
    Outputs outputs = BeaconFrom(kSeven, 5);
    outputs.beacon.wheels = {1.5, -2.5};
    outputs.beacon.world_from_body = {{3.25, -4.5}, 0.75};
    outputs.beacon.toward_world = {8, 9};
    outputs.beacon.mode = Mode::kSensorOnly;
    outputs.beacon.rule = Rule::kGiveWay;
    outputs.beacon.gives_way_to = VehicleId{2};
    outputs.beacon.order = {6, 8, kSeven};
    vehicle_.Link().Send(outputs);
    got = Take(reader);
    return !got.empty() && got[0].valid;
  }));
  const ForeignBeacon& beacon = got[0].beacon;
  EXPECT_EQ(beacon.vehicle, 7U);
  EXPECT_EQ(beacon.seq, 5U);
  EXPECT_EQ(beacon.left_rad_s, 1.5);
  EXPECT_EQ(beacon.right_rad_s, -2.5);
  EXPECT_EQ(beacon.x_m, 3.25);
  EXPECT_EQ(beacon.y_m, -4.5);
  EXPECT_EQ(beacon.heading_rad, 0.75);
  EXPECT_EQ(beacon.toward_y_m, 9);
  EXPECT_EQ(beacon.mode, 1U);
  EXPECT_EQ(beacon.rule, 4U);
  EXPECT_EQ(beacon.gives_way_to, 2U);
  EXPECT_EQ(beacon.order_waited_ticks, 6U);
  EXPECT_EQ(beacon.order_vehicle, 7U);
  EXPECT_NE(beacon.crc, 0U);
}

// A status gets new members at its end: a reader that knows fewer can still read it.
TEST_F(ForeignReader, OfAnOlderStatusReadsTheMembersItKnows) {
  const dds_entity_t reader = stranger_.MakeStatusReader();
  VehicleStatus status;
  status.vehicle = kSeven;
  status.epoch = WorldEpoch{8};
  status.tick = Tick{9};
  std::vector<ForeignStatus> got;
  ASSERT_TRUE(Eventually([&] {
    vehicle_.Link().SendStatus(status);
    got = TakeStatuses(reader);
    return !got.empty();
  }));
  EXPECT_EQ(got[0].vehicle, 7U);
  EXPECT_EQ(got[0].world_epoch, 8U);
  EXPECT_EQ(got[0].tick, 9U);
}

TEST_F(ForeignReader, TellsVehiclesApartByTheirKey) {
  Beaconing eight(OptionsIn(domain_), VehicleId{8});
  Beaconing nine(OptionsIn(domain_), VehicleId{9});
  const dds_entity_t reader = stranger_.MakeReader(AsOffered());
  std::set<std::pair<std::uint32_t, dds_instance_handle_t>> instances;
  ASSERT_TRUE(Eventually([&] {
    vehicle_.Send();
    eight.Send();
    nine.Send();
    for (const ForeignSample& sample : Take(reader)) {
      if (sample.valid) instances.emplace(sample.beacon.vehicle, sample.instance);
    }
    return instances.size() >= 3;
  }));
  Repeat(milliseconds(200), [&] {
    eight.Send();
    for (const ForeignSample& sample : Take(reader)) {
      if (sample.valid) instances.emplace(sample.beacon.vehicle, sample.instance);
    }
  });
  EXPECT_EQ(instances.size(), 3U);  // one instance a vehicle, always the same
}

TEST_F(ForeignReader, InOneVehiclesPartitionHearsThatVehicleOnly) {
  Beaconing eight(OptionsIn(domain_), VehicleId{8});
  const dds_entity_t reader = stranger_.MakeReader({.partition = "main/v7"});
  const dds_entity_t all = stranger_.MakeReader(AsOffered());
  ASSERT_TRUE(Hears(reader));
  ASSERT_TRUE(Hears(all, [&](const ForeignSample& sample) {
    eight.Send();
    return sample.valid && sample.beacon.vehicle == 8;
  }));
  EXPECT_FALSE(Hears(
      reader,
      [&](const ForeignSample& sample) {
        eight.Send();
        return sample.beacon.vehicle != 7;
      },
      milliseconds(200)));
}

TEST_F(ForeignReader, WithoutADeadlineOrALeaseHears) {
  EXPECT_TRUE(Hears(stranger_.MakeReader({.partition = "main/*"})));
}

TEST_F(ForeignReader, ThatAsksForLessThanManualLivelinessHears) {
  ForeignQos qos = AsOffered();
  qos.liveliness = DDS_LIVELINESS_AUTOMATIC;
  EXPECT_TRUE(Hears(stranger_.MakeReader(qos)));
}

TEST_F(ForeignReader, WithADeadlineShorterThanOfferedIsRefusedAndTold) {
  ForeignQos qos = AsOffered();
  qos.deadline_ms = 50;
  expected_policy_ = DDS_DEADLINE_QOS_POLICY_ID;
  ExpectDeaf(qos);
}

TEST_F(ForeignReader, WithALeaseShorterThanOfferedIsRefusedAndTold) {
  ForeignQos qos = AsOffered();
  qos.lease_ms = 100;
  expected_policy_ = DDS_LIVELINESS_QOS_POLICY_ID;
  ExpectDeaf(qos);
}

TEST_F(ForeignReader, ThatAsksForReliabilityIsRefusedAndTold) {
  ForeignQos qos = AsOffered();
  qos.reliable = true;
  expected_policy_ = DDS_RELIABILITY_QOS_POLICY_ID;
  ExpectDeaf(qos);
}

// Fast DDS calls a partition that does not match no policy's fault; Cyclone says so.
TEST_F(ForeignReader, OfAnotherAreaHearsNothingAndIsTold) {
  ForeignQos qos = AsOffered();
  expected_policy_ = DDS_PARTITION_QOS_POLICY_ID;
  qos.partition = "north/*";
  ExpectDeaf(qos);
}

TEST_F(ForeignReader, WithoutAPartitionHearsNothingAndIsTold) {
  ForeignQos qos = AsOffered();
  qos.partition = std::nullopt;
  expected_policy_ = DDS_PARTITION_QOS_POLICY_ID;
  ExpectDeaf(qos);
}

TEST_F(ForeignReader, WithoutAPartitionHearsAVehicleThatIsPartitionFree) {
  link::LinkOptions options = OptionsIn(domain_);
  options.partition_free = true;
  Beaconing open(options, VehicleId{8});
  ForeignQos qos = AsOffered();
  qos.partition = std::nullopt;
  const dds_entity_t reader = stranger_.MakeReader(qos);
  const dds_entity_t usual = stranger_.MakeReader(AsOffered());
  const auto is_eight = [&](const ForeignSample& sample) {
    open.Send();
    return sample.valid && sample.beacon.vehicle == 8;
  };
  open.Send();
  EXPECT_TRUE(Hears(usual, [&](const ForeignSample&) {
    open.Send();
    return true;
  }));
  EXPECT_TRUE(Eventually([&] {
    open.Send();
    return std::ranges::any_of(Take(reader), is_eight);
  }));
  EXPECT_TRUE(Eventually([&] {
    open.Send();
    return std::ranges::any_of(Take(usual), is_eight);
  }));
}

// The second beacon is for strangers alone.
TEST_F(ForeignReader, APartitionFreeVehicleIsHeardOnceByItsPeers) {
  link::LinkOptions options = OptionsIn(domain_);
  options.partition_free = true;
  Beaconing open(options, VehicleId{8});
  ReceptionMonitor monitor(vehicle_.Link());
  ASSERT_TRUE(Eventually([&] {
    open.Send();
    monitor.Listen();
    return monitor.Beacons().size() >= 30;
  }));
  std::set<std::uint32_t> seqs;
  for (const ReceivedBeacon& received : monitor.Beacons()) {
    EXPECT_TRUE(seqs.insert(received.beacon.seq).second) << received.beacon.seq;
    EXPECT_TRUE(received.name_valid);
  }
  EXPECT_EQ(vehicle_.Link().Counters().matched_peers, 1U);
}

TEST_F(ForeignReader, IsToldOfAMissedDeadline) {
  const dds_entity_t reader = stranger_.MakeReader(AsOffered());
  ASSERT_TRUE(Hears(reader));
  EXPECT_TRUE(Eventually([&] {
    dds_requested_deadline_missed_status_t status{};
    dds_get_requested_deadline_missed_status(reader, &status);
    return status.total_count > 0;
  }));
}

TEST_F(ForeignReader, IsToldOfLivelinessLostAndRegained) {
  const dds_entity_t reader = stranger_.MakeReader(AsOffered());
  const auto alive = [&] {
    dds_liveliness_changed_status_t status{};
    dds_get_liveliness_changed_status(reader, &status);
    return status.alive_count;
  };
  ASSERT_TRUE(Hears(reader));
  EXPECT_EQ(alive(), 1U);
  EXPECT_TRUE(Eventually([&] { return alive() == 0; }));
  EXPECT_TRUE(Hears(reader));
  EXPECT_TRUE(Eventually([&] {
    vehicle_.Send();
    return alive() == 1;
  }));
}

TEST_F(ForeignReader, IsToldThatAVehicleLeft) {
  std::optional<Beaconing> eight;
  eight.emplace(OptionsIn(domain_), VehicleId{8});
  const dds_entity_t reader = stranger_.MakeReader({.partition = "main/v8"});
  dds_instance_handle_t instance = 0;
  ASSERT_TRUE(Eventually([&] {
    eight->Send();
    for (const ForeignSample& sample : Take(reader)) instance = sample.instance;
    return instance != 0;
  }));
  Take(reader);
  eight.reset();
  EXPECT_TRUE(Eventually([&] {
    return std::ranges::any_of(Take(reader), [&](const ForeignSample& sample) {
      return sample.instance == instance && !sample.alive;
    });
  }));
}

}  // namespace
}  // namespace giveway::test
