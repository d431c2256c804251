// Who is heard, and what a beacon that is not to be believed looks like when it arrives.
#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "tests/link/fleet.h"
#include "tests/link/raw_vehicle.h"

namespace giveway::test {
namespace {

using ::testing::Each;
using ::testing::Field;

constexpr VehicleId kListener{1000};

wire::Beacon WireBeaconFrom(VehicleId id, std::uint32_t seq = 1) {
  return link::ToWire(BeaconFrom(id, seq).beacon);
}

TEST(Beacons, OfTwentyFiveVehiclesAreAllHeard) {
  const DomainLock domain;
  link::VehicleLink listener(OptionsIn(domain));
  listener.Open(kListener);
  ReceptionMonitor monitor(listener);
  std::vector<std::unique_ptr<Beaconing>> fleet;
  for (std::uint32_t id = 1; id <= 25; ++id) {
    fleet.push_back(std::make_unique<Beaconing>(OptionsIn(domain), VehicleId{id}));
  }
  EXPECT_TRUE(Eventually([&] {
    for (auto& vehicle : fleet) vehicle->Send();
    monitor.Listen();
    // The library hands over samples of a matched writer before it reports the match.
    return monitor.Heard().size() == 25 && listener.Counters().matched_peers >= 25U;
  })) << "heard "
      << monitor.Heard().size();
  EXPECT_EQ(listener.Counters().matched_peers, 25U);
}

TEST(Beacons, CarryWhatWasSentAndTheTimeOfTheReceiver) {
  const DomainLock domain;
  Beaconing sender(OptionsIn(domain), VehicleId{7});
  link::VehicleLink listener(OptionsIn(domain));
  listener.Open(kListener);
  std::vector<ReceivedBeacon> got;
  ASSERT_TRUE(Eventually([&] {
    sender.Send();
    const link::Taken taken = listener.Take(SteadyTime{123});
    got.assign(taken.inputs.beacons.begin(), taken.inputs.beacons.end());
    return !got.empty();
  }));
  EXPECT_EQ(got[0].beacon.vehicle, VehicleId{7});
  EXPECT_EQ(got[0].received, SteadyTime{123});
  EXPECT_TRUE(got[0].crc_valid);
  EXPECT_TRUE(got[0].name_valid);
  EXPECT_NE(got[0].writer, 0U);
}

TEST(Beacons, OfTheOwnVehicleAreNotHandedOverAndNoPeerIsCounted) {
  const DomainLock domain;
  Beaconing alone(OptionsIn(domain), VehicleId{1});
  Beaconing peer(OptionsIn(domain), VehicleId{2});
  ReceptionMonitor monitor(alone.Link());
  ASSERT_TRUE(Eventually([&] {
    alone.Send();
    peer.Send();
    monitor.Listen();
    return monitor.Beacons().size() >= 20;
  }));
  for (const ReceivedBeacon& received : monitor.Beacons()) {
    EXPECT_EQ(received.beacon.vehicle, VehicleId{2});
  }
  EXPECT_EQ(alone.Link().Counters().matched_peers, 1U);
  EXPECT_EQ(alone.Link().Counters().refused.unbound_samples, 0U);
  EXPECT_THAT(monitor.EventsOf(QosEventKind::kMatched), Each(VehicleId{2}));
}

TEST(Beacons, WithABrokenSumArriveAsBroken) {
  const DomainLock domain;
  RawSender sender(OptionsIn(domain), "main/v5");
  link::VehicleLink listener(OptionsIn(domain));
  listener.Open(kListener);
  ReceptionMonitor monitor(listener);
  wire::Beacon broken = WireBeaconFrom(VehicleId{5});
  broken.tick() ^= 4U;
  ASSERT_TRUE(Eventually([&] {
    sender.Send(broken);
    monitor.Listen();
    return !monitor.Beacons().empty();
  }));
  EXPECT_FALSE(monitor.Beacons()[0].crc_valid);
  EXPECT_TRUE(monitor.Beacons()[0].name_valid);
}

TEST(Beacons, InAnotherVehiclesNameArriveAsMisnamed) {
  const DomainLock domain;
  RawSender liar(OptionsIn(domain), "main/v5");
  RawSender nameless(OptionsIn(domain), "main/*");
  link::VehicleLink listener(OptionsIn(domain));
  listener.Open(kListener);
  ReceptionMonitor monitor(listener);
  bool heard_liar = false;
  bool heard_nameless = false;
  ASSERT_TRUE(Eventually([&] {
    liar.Send(WireBeaconFrom(VehicleId{3}));
    nameless.Send(WireBeaconFrom(VehicleId{4}));
    monitor.Listen();
    for (const ReceivedBeacon& received : monitor.Beacons()) {
      heard_liar |= received.beacon.vehicle == VehicleId{3};
      heard_nameless |= received.beacon.vehicle == VehicleId{4};
    }
    return heard_liar && heard_nameless;
  }));
  EXPECT_THAT(monitor.Beacons(), Each(Field(&ReceivedBeacon::name_valid, false)));
  EXPECT_THAT(monitor.Beacons(), Each(Field(&ReceivedBeacon::crc_valid, true)));
}

TEST(Beacons, OfTwoVehiclesWithOneIdComeFromTwoWriters) {
  const DomainLock domain;
  Beaconing first(OptionsIn(domain), VehicleId{5});
  Beaconing second(OptionsIn(domain), VehicleId{5});
  link::VehicleLink listener(OptionsIn(domain));
  listener.Open(kListener);
  ReceptionMonitor monitor(listener);
  std::set<std::uint64_t> writers;
  EXPECT_TRUE(Eventually([&] {
    first.Send();
    second.Send();
    monitor.Listen();
    for (const ReceivedBeacon& received : monitor.Beacons()) writers.insert(received.writer);
    return writers.size() == 2;
  }));
  EXPECT_THAT(monitor.Beacons(), Each(Field(&ReceivedBeacon::name_valid, true)));
}

TEST(Beacons, OfAnotherAreaAreNotHeard) {
  const DomainLock domain;
  link::LinkOptions elsewhere = OptionsIn(domain);
  elsewhere.area = "north-2";
  Beaconing there(elsewhere, VehicleId{1});
  Beaconing here(OptionsIn(domain), VehicleId{2});
  link::VehicleLink listener(OptionsIn(domain));
  listener.Open(kListener);
  ReceptionMonitor monitor(listener);
  ASSERT_TRUE(Eventually([&] {
    there.Send();
    here.Send();
    monitor.Listen();
    return monitor.Beacons().size() >= 20;
  }));
  EXPECT_FALSE(monitor.Heard().contains(VehicleId{1}));
}

TEST(Beacons, OverwrittenBeforeADrainAreCountedAsSuperseded) {
  const DomainLock domain;
  RawSender sender(OptionsIn(domain), "main/v5");
  RawListener listener(OptionsIn(domain));
  std::uint32_t seq = 0;
  ASSERT_TRUE(Eventually([&] {
    sender.Send(WireBeaconFrom(VehicleId{5}, ++seq));
    listener.Listen();
    return listener.Heard() > 0;
  }));
  // Drained in time, nothing is superseded.
  const std::size_t before = listener.Heard();
  for (int i = 0; i < 5; ++i) {
    sender.Send(WireBeaconFrom(VehicleId{5}, ++seq));
    ASSERT_TRUE(Eventually([&, heard = listener.Heard()] {
      listener.Listen();
      return listener.Heard() > heard;
    }));
  }
  EXPECT_EQ(listener.Superseded(), 0U);
  EXPECT_GE(listener.Heard(), before + 5);
  // Of ten sent at once the reader keeps the last five. The gap shows with the next one taken.
  // A machine that stalls may deliver them in parts, of which fewer are superseded.
  std::uint64_t superseded = 0;
  for (int burst = 0; burst < 5 && superseded != 5; ++burst) {
    const std::uint64_t earlier = listener.Superseded();
    for (int i = 0; i < 10; ++i) sender.Send(WireBeaconFrom(VehicleId{5}, ++seq));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // lets them all arrive undrained
    ASSERT_TRUE(Eventually([&, heard = listener.Heard()] {
      listener.Listen();
      return listener.Heard() > heard;
    }));
    superseded = listener.Superseded() - earlier;
  }
  EXPECT_EQ(superseded, 5U);
}

TEST(Beacons, WithAnUnknownEnumeratorAndASoundSumAreDroppedAndCounted) {
  const DomainLock domain;
  RawSender sender(OptionsIn(domain), "main/v5");
  RawListener listener(OptionsIn(domain));
  Beacon unknown = BeaconFrom(VehicleId{5}, 1).beacon;
  unknown.mode = static_cast<Mode>(77);
  const wire::Beacon newer = link::ToWire(unknown);
  EXPECT_TRUE(Eventually([&] {
    sender.Send(newer);
    listener.Listen();
    return listener.Unreadable() > 0;
  }));
  EXPECT_EQ(listener.Heard(), 0U);
}

TEST(BeaconQos, IsWhatTheProfileSays) {
  const DomainLock domain;
  link::VehicleLink vehicle(OptionsIn(domain));
  vehicle.Open(VehicleId{1});
  EXPECT_EQ(vehicle.BeaconQos().deadline_offered_ms, 100);
  EXPECT_EQ(vehicle.BeaconQos().deadline_requested_ms, 150);
  EXPECT_EQ(vehicle.BeaconQos().lease_ms, 250);
}

}  // namespace
}  // namespace giveway::test
