// What our vehicles hear of Cyclone DDS.
#include <gmock/gmock.h>

#include <chrono>
#include <optional>
#include <set>

#include "services/link/fastdds/packets_of_process.h"
#include "tests/link/fleet.h"
#include "tests/link/foreign/foreign.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr VehicleId kListener{1000};
constexpr VehicleId kFive{5};

// What our readers request.
ForeignQos AsRequested(const char* partition = "main/v5") {
  return {.partition = partition, .deadline_ms = 100, .lease_ms = 250};
}

class ForeignWriter : public ::testing::Test {
 protected:
  ForeignWriter() : listener_(OptionsIn(domain_)) { listener_.Open(kListener); }

  // The first line about an endpoint that will not match. Its clock runs fast: an endpoint is
  // judged a second after it was found.
  std::string UnfitLine() {
    std::string line;
    SteadyTime now{0};
    Eventually([&] {
      now += std::chrono::seconds(2);
      for (std::string& unfit : listener_.TakeUnfit(now)) line = std::move(unfit);
      return !line.empty();
    });
    return line;
  }

  static ForeignBeacon BeaconOf(VehicleId id, std::uint32_t seq) {
    return ForeignFrom(BeaconFrom(id, seq).beacon);
  }
  // Writes as vehicle 5 until `is_so`.
  bool WriteUntil(dds_entity_t writer, const std::function<bool()>& is_so, VehicleId id = kFive) {
    return Eventually([&] {
      Write(writer, BeaconOf(id, ++seq_));
      monitor_.Listen();
      return is_so();
    });
  }
  bool IsHeard(dds_entity_t writer) {
    return WriteUntil(writer, [&] { return monitor_.Heard().contains(kFive); });
  }
  // That it is not heard, while another one is: then discovery is through.
  void ExpectUnheard(dds_entity_t writer) {
    const dds_entity_t sound = stranger_->MakeWriter(AsRequested("main/v6"));
    std::uint32_t seq = 0;
    ASSERT_TRUE(WriteUntil(writer, [&] {
      Write(sound, BeaconOf(VehicleId{6}, ++seq));
      return monitor_.Beacons().size() >= 20;
    }));
    EXPECT_THAT(monitor_.Heard(), ::testing::ElementsAre(VehicleId{6}));
    for (const ReceivedBeacon& received : monitor_.Beacons()) {
      EXPECT_EQ(received.beacon.vehicle, VehicleId{6});
    }
  }
  void ExpectRefused(const ForeignQos& qos, dds_qos_policy_id_t policy) {
    const dds_entity_t writer = stranger_->MakeWriter(qos);
    ExpectUnheard(writer);
    dds_offered_incompatible_qos_status_t status{};
    dds_get_offered_incompatible_qos_status(writer, &status);
    EXPECT_GT(status.total_count, 0U);
    EXPECT_EQ(status.last_policy_id, static_cast<std::uint32_t>(policy));
    const auto reported = monitor_.EventsOf(QosEventKind::kIncompatibleQos);
    EXPECT_THAT(reported, Not(IsEmpty()));
    EXPECT_THAT(reported, Each(kFive));  // never the valid one next to it
  }

  DomainLock domain_;
  std::optional<ForeignParticipant> stranger_{std::in_place, domain_.Domain()};
  link::VehicleLink listener_;
  ReceptionMonitor monitor_{listener_};
  std::uint32_t seq_ = 0;
};

TEST_F(ForeignWriter, IsHeardInEveryField) {
  Beacon said = BeaconFrom(kFive, 9).beacon;
  said.wheels = {1.5, -2.5};
  said.cruise_m_s = 0.3;
  said.world_from_body = {{3.25, -4.5}, 0.75};
  said.toward_world = {8, 9};
  said.mode = Mode::kSensorOnly;
  said.rule = Rule::kGiveWay;
  said.gives_way_to = VehicleId{2};
  said.order = {6, 8, kFive};
  const dds_entity_t writer = stranger_->MakeWriter(AsRequested());
  ASSERT_TRUE(Eventually([&] {
    Write(writer, ForeignFrom(said));
    monitor_.Listen();
    return !monitor_.Beacons().empty();
  }));
  const ReceivedBeacon& heard = monitor_.Beacons()[0];
  EXPECT_TRUE(heard.crc_valid);
  EXPECT_TRUE(heard.name_valid);
  EXPECT_NE(heard.writer, 0U);
  EXPECT_EQ(heard.beacon.seq, 9U);
  EXPECT_EQ(heard.beacon.wheels.left_rad_s, 1.5);
  EXPECT_EQ(heard.beacon.world_from_body, said.world_from_body);
  EXPECT_EQ(heard.beacon.toward_world, said.toward_world);
  EXPECT_EQ(heard.beacon.mode, said.mode);
  EXPECT_EQ(heard.beacon.rule, said.rule);
  EXPECT_EQ(heard.beacon.gives_way_to, said.gives_way_to);
  EXPECT_EQ(heard.beacon.order, said.order);
}

TEST_F(ForeignWriter, IsAPeerWithItsName) {
  // The library hands over samples of a matched writer before it reports the match.
  ASSERT_TRUE(WriteUntil(stranger_->MakeWriter(AsRequested()), [&] {
    return monitor_.Heard().contains(kFive) && !monitor_.EventsOf(QosEventKind::kMatched).empty();
  }));
  EXPECT_THAT(monitor_.EventsOf(QosEventKind::kMatched), Each(kFive));
  EXPECT_EQ(listener_.Counters().matched_peers, 1U);
  EXPECT_EQ(listener_.Counters().refused.unreadable_samples, 0U);
}

TEST_F(ForeignWriter, AndAnotherAreTwoVehicles) {
  const dds_entity_t five = stranger_->MakeWriter(AsRequested());
  const dds_entity_t six = stranger_->MakeWriter(AsRequested("main/v6"));
  std::set<std::uint64_t> writers;
  EXPECT_TRUE(WriteUntil(five, [&] {
    Write(six, BeaconOf(VehicleId{6}, seq_));
    for (const ReceivedBeacon& received : monitor_.Beacons()) writers.insert(received.writer);
    return monitor_.Heard().size() == 2 && writers.size() == 2;
  }));
}

TEST_F(ForeignWriter, ThatOffersReliabilityIsHeardToo) {
  ForeignQos qos = AsRequested();
  qos.reliable = true;
  EXPECT_TRUE(IsHeard(stranger_->MakeWriter(qos)));
}

TEST_F(ForeignWriter, InAnotherVehiclesNameIsHeardAsMisnamed) {
  const dds_entity_t writer = stranger_->MakeWriter(AsRequested());
  ASSERT_TRUE(WriteUntil(
      writer, [&] { return !monitor_.Beacons().empty(); }, VehicleId{3}));
  EXPECT_THAT(monitor_.Beacons(), Each(::testing::Field(&ReceivedBeacon::name_valid, false)));
  EXPECT_THAT(monitor_.Beacons(), Each(::testing::Field(&ReceivedBeacon::crc_valid, true)));
}

TEST_F(ForeignWriter, WithABrokenSumIsHeardAsBroken) {
  const dds_entity_t writer = stranger_->MakeWriter(AsRequested());
  ForeignBeacon broken = BeaconOf(kFive, 1);
  broken.tick ^= 4U;
  ASSERT_TRUE(Eventually([&] {
    Write(writer, broken);
    monitor_.Listen();
    return !monitor_.Beacons().empty();
  }));
  EXPECT_FALSE(monitor_.Beacons()[0].crc_valid);
}

TEST_F(ForeignWriter, ThatFallsSilentMissesItsDeadlineByName) {
  ASSERT_TRUE(IsHeard(stranger_->MakeWriter(AsRequested())));
  EXPECT_TRUE(Eventually([&] {
    monitor_.Listen();
    return !monitor_.EventsOf(QosEventKind::kDeadlineMissed).empty();
  }));
  EXPECT_THAT(monitor_.EventsOf(QosEventKind::kDeadlineMissed), Each(kFive));
}

TEST_F(ForeignWriter, ThatFallsSilentIsNotAliveUntilItSpeaksAgain) {
  const dds_entity_t writer = stranger_->MakeWriter(AsRequested());
  ASSERT_TRUE(IsHeard(writer));
  ASSERT_TRUE(Eventually([&] {
    monitor_.Listen();
    return !monitor_.EventsOf(QosEventKind::kLivelinessLost).empty();
  }));
  EXPECT_THAT(monitor_.EventsOf(QosEventKind::kLivelinessLost), Each(kFive));
  EXPECT_TRUE(WriteUntil(
      writer, [&] { return !monitor_.EventsOf(QosEventKind::kLivelinessBack).empty(); }));
}

TEST_F(ForeignWriter, ThatStillSpeaksDoesNotKeepASilentOneAlive) {
  const dds_entity_t five = stranger_->MakeWriter(AsRequested());
  const dds_entity_t six = stranger_->MakeWriter(AsRequested("main/v6"));
  ASSERT_TRUE(WriteUntil(five, [&] {
    Write(six, BeaconOf(VehicleId{6}, seq_));
    return monitor_.Heard().size() == 2;
  }));
  EXPECT_TRUE(
      WriteUntil(five, [&] { return !monitor_.EventsOf(QosEventKind::kLivelinessLost).empty(); }));
  EXPECT_THAT(monitor_.EventsOf(QosEventKind::kLivelinessLost), Each(VehicleId{6}));
}

// Fast DDS 2.9.1 ignores Cyclone's notice that an endpoint is gone: only liveliness reports it.
TEST_F(ForeignWriter, ThatLeavesIsNotAliveByName) {
  const dds_entity_t writer = stranger_->MakeWriter(AsRequested());
  ASSERT_TRUE(IsHeard(writer));
  dds_delete(writer);
  EXPECT_TRUE(Eventually([&] {
    monitor_.Listen();
    return !monitor_.EventsOf(QosEventKind::kLivelinessLost).empty();
  }));
  EXPECT_THAT(monitor_.EventsOf(QosEventKind::kLivelinessLost), Each(kFive));
}

// Nor that a participant is: it stays a peer until the ten seconds of its lease are over.
TEST_F(ForeignWriter, WhoseProcessEndsIsUnmatchedByName) {
  ASSERT_TRUE(IsHeard(stranger_->MakeWriter(AsRequested())));
  stranger_.reset();
  EXPECT_TRUE(Eventually([&] {
    monitor_.Listen();
    return !monitor_.EventsOf(QosEventKind::kUnmatched).empty();
  }));
  EXPECT_THAT(monitor_.EventsOf(QosEventKind::kUnmatched), Each(kFive));
  EXPECT_EQ(listener_.Counters().matched_peers, 0U);
}

TEST_F(ForeignWriter, WithADeadlineLongerThanRequestedIsRefusedAndTold) {
  ForeignQos qos = AsRequested();
  qos.deadline_ms = 200;
  ExpectRefused(qos, DDS_DEADLINE_QOS_POLICY_ID);
}

TEST_F(ForeignWriter, WithALeaseLongerThanRequestedIsRefusedAndTold) {
  ForeignQos qos = AsRequested();
  qos.lease_ms = 500;
  ExpectRefused(qos, DDS_LIVELINESS_QOS_POLICY_ID);
}

TEST_F(ForeignWriter, WithAutomaticLivelinessIsRefusedAndTold) {
  ForeignQos qos = AsRequested();
  qos.liveliness = DDS_LIVELINESS_AUTOMATIC;
  ExpectRefused(qos, DDS_LIVELINESS_QOS_POLICY_ID);
}

// DDS reports a policy only by a counter of the reader, and a partition not at all: our log says
// both.
TEST_F(ForeignWriter, ThatOffersTooLittleIsReportedWithWhatItOffers) {
  ForeignQos slow = AsRequested();
  slow.deadline_ms = 200;
  stranger_->MakeWriter(slow);
  stranger_->MakeWriter(AsRequested("north/v7"));
  stranger_->MakeWriter(AsRequested("main/v8"));
  EXPECT_THAT(UnfitLine(),
              AllOf(HasSubstr("a writer of fleet/beacon in main/v5 (Eclipse Cyclone DDS"),
                    HasSubstr("deadline offered 200 ms, requested 150 ms")));
}

TEST_F(ForeignWriter, WithoutAPartitionIsReported) {
  ForeignQos lost = AsRequested();
  lost.partition = std::nullopt;
  stranger_->MakeWriter(lost);
  EXPECT_THAT(UnfitLine(), AllOf(HasSubstr("a writer of fleet/beacon with no partition"),
                                 HasSubstr("ours is in main/*")));
}

TEST_F(ForeignWriter, WithABrokenSumIsToldWhatItShouldBe) {
  const dds_entity_t writer = stranger_->MakeWriter(AsRequested());
  ForeignBeacon broken = BeaconOf(kFive, 1);
  const std::uint32_t right = broken.crc;
  broken.crc ^= 4U;
  std::vector<Refusal> refusals;
  ASSERT_TRUE(Eventually([&] {
    Write(writer, broken);
    for (const Refusal& refusal : listener_.Take(SteadyTime{0}).refusals) {
      refusals.push_back(refusal);
    }
    return !refusals.empty();
  }));
  EXPECT_EQ(refusals[0].why, "crc is " + std::to_string(broken.crc) + ", must be " +
                                 std::to_string(right) + " for its fields as they arrived");
  EXPECT_STREQ(refusals[0].counter, "rejected_crc");
}

TEST_F(ForeignWriter, OfAnotherAreaIsNotHeard) {
  ExpectUnheard(stranger_->MakeWriter(AsRequested("north/v5")));
}

TEST_F(ForeignWriter, WithoutAPartitionIsNotHeard) {
  ForeignQos qos = AsRequested();
  qos.partition = std::nullopt;
  ExpectUnheard(stranger_->MakeWriter(qos));
}

// Of a writer with 2000 bytes of user data Cyclone makes an announcement of two fragments, of which
// nothing can be judged before the library has taken both: they are dropped, as log and status say.
class LongAnnouncement : public ::testing::Test {
 protected:
  static std::uint64_t Dropped() {
    return link::PacketsOfProcess().Of(PacketDrop::kFragmentedAnnouncement);
  }
  static ForeignQos WithUserData() {
    ForeignQos qos = AsRequested();
    qos.user_data_bytes = 2000;
    return qos;
  }
  bool Matches() {
    listener_.Take(std::chrono::steady_clock::now().time_since_epoch());
    return listener_.Counters().matched_peers == 1;
  }

  DomainLock domain_;
  link::VehicleLink listener_{OptionsIn(domain_)};
  std::uint64_t before_ = Dropped();
};

TEST_F(LongAnnouncement, InFragmentsIsDroppedAndCounted) {
  listener_.Open(kListener);
  ForeignParticipant stranger(domain_.Domain());
  stranger.MakeWriter(WithUserData());
  EXPECT_TRUE(Eventually([&] { return Dropped() > before_; }));
  Repeat(milliseconds(500), [&] { EXPECT_FALSE(Matches()); });
}

TEST_F(LongAnnouncement, InOnePieceIsFound) {
  listener_.Open(kListener);
  ForeignParticipant stranger(domain_.Domain(), 8000);
  stranger.MakeWriter(WithUserData());
  EXPECT_TRUE(Eventually([&] { return Matches(); }));
  EXPECT_EQ(Dropped(), before_);
}

}  // namespace
}  // namespace giveway::test
