// Which peer a reader's event is attributed to. No participant is created: the library's callbacks
// are called by hand, in the orders its threads call them.
#include "services/link/inbox/peer_events.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

namespace giveway::link {
namespace {

using ::testing::ElementsAre;

constexpr auto kFound = DiscoveryListener::Change::kFound;

rtps::GUID_t WriterNumber(std::uint8_t number) {
  rtps::GUID_t guid;
  guid.guidPrefix.value[11] = number;
  guid.entityId.value[0] = 1;
  return guid;
}

class PeerEventsTest : public ::testing::Test {
 protected:
  void Find(std::uint8_t writer, const char* partition) {
    names_.OnWriter(kFound, WriterNumber(writer), {partition});
  }
  // On a thread of its own, so that it is no writer this thread found.
  void FindElsewhere(std::uint8_t writer, const char* partition) {
    std::thread([&] { Find(writer, partition); }).join();
  }
  void Refuse() { events_.on_requested_incompatible_qos(nullptr, {}); }
  void Match(std::uint8_t writer) {
    dds::SubscriptionMatchedStatus status;
    status.current_count_change = 1;
    status.last_publication_handle = WriterNumber(writer);
    events_.on_subscription_matched(nullptr, status);
  }
  void Unmatch(std::uint8_t writer) {
    dds::SubscriptionMatchedStatus status;
    status.current_count_change = -1;
    status.last_publication_handle = WriterNumber(writer);
    events_.on_subscription_matched(nullptr, status);
  }
  void Live(std::uint8_t writer, bool alive) {
    dds::LivelinessChangedStatus status;
    (alive ? status.alive_count_change : status.not_alive_count_change) = 1;
    status.last_publication_handle = WriterNumber(writer);
    events_.on_liveliness_changed(nullptr, status);
  }
  void Miss(std::uint32_t vehicle) {
    dds::RequestedDeadlineMissedStatus status;
    for (std::size_t i = 0; i < 4; ++i) {
      status.last_instance_handle.value[i] = static_cast<rtps::octet>(vehicle >> (24U - 8U * i));
    }
    events_.on_requested_deadline_missed(nullptr, status);
  }
  std::vector<QosEvent> Emitted(SteadyTime now = SteadyTime{0}) {
    std::vector<QosEvent> emitted;
    const ReaderNews news = events_.Take();
    names_.Update();
    peers_.Translate(news, now, emitted);
    return emitted;
  }
  // Peers that the own clock finds to have missed a deadline of 150 ms.
  std::vector<VehicleId> MissedAt(int ms) {
    std::vector<QosEvent> emitted;
    peers_.Watch(std::chrono::milliseconds(ms), std::chrono::milliseconds(150), emitted);
    std::vector<VehicleId> missed;
    for (const QosEvent& event : emitted) missed.push_back(event.vehicle);
    return missed;
  }
  void Hear(std::uint32_t vehicle, int ms) {
    peers_.Heard(VehicleId{vehicle}, std::chrono::milliseconds(ms));
  }
  const PeerEvents& Peers() const { return peers_; }
  std::uint32_t Dropped() const { return events_.Dropped(); }
  // The vehicles that are reported as incompatible.
  std::vector<VehicleId> Unfit() {
    std::vector<QosEvent> emitted;
    const ReaderNews events = events_.Take();
    names_.Update();
    peers_.Translate(events, SteadyTime{0}, emitted);
    std::vector<VehicleId> unfit;
    for (const QosEvent& event : emitted) {
      if (event.kind == QosEventKind::kIncompatibleQos) unfit.push_back(event.vehicle);
    }
    return unfit;
  }

 private:
  WriterNames names_;
  ReaderEvents events_;
  PeerEvents peers_{names_, WriterNumber(99).guidPrefix, "main"};
};

TEST_F(PeerEventsTest, NamesTheUnfitWriterThoughAnotherIsFoundBeforeTheEventIsRead) {
  Find(1, "main/v5");
  Refuse();
  Find(2, "main/v6");  // its match is not through yet
  EXPECT_THAT(Unfit(), ElementsAre(VehicleId{5}));
}

TEST_F(PeerEventsTest, NamesTheSameWriterAgainWhenItsQosChangesAndStillDoesNotFit) {
  FindElsewhere(2, "main/v6");
  Find(1, "main/v5");
  Refuse();
  EXPECT_THAT(Unfit(), ElementsAre(VehicleId{5}));
  Find(1, "main/v5");
  Refuse();
  EXPECT_THAT(Unfit(), ElementsAre(VehicleId{5}));
}

// A reader that is made or changed meets writers that were found long before, on other threads.
TEST_F(PeerEventsTest, NamesEachUnmatchedWriterOnceWhenTheThreadFoundNoneOfThem) {
  FindElsewhere(1, "main/v5");
  FindElsewhere(2, "main/v6");
  FindElsewhere(3, "main/v7");
  FindElsewhere(4, "north/v8");
  Find(9, "main/v9");  // this thread's own
  Match(9);
  Match(2);
  Refuse();
  Refuse();
  Refuse();
  EXPECT_THAT(Unfit(), ElementsAre(VehicleId{7}, VehicleId{5}, kNoVehicle));
}

TEST_F(PeerEventsTest, NamesNobodyForAWriterOfAnotherArea) {
  Find(1, "north/v5");
  Refuse();
  EXPECT_THAT(Unfit(), ElementsAre(kNoVehicle));
}

// Issue 21, number 8: a loop hung for 5 s, 96 ids that are gone, three peers that join.
TEST_F(PeerEventsTest, RepeatedMissesOfTheDepartedCrowdOutNoMatch) {
  for (int period = 0; period < 34; ++period) {
    for (std::uint32_t id = 100; id < 196; ++id) Miss(id);
  }
  for (std::uint8_t id = 1; id <= 3; ++id) {
    Find(id, ("main/v" + std::to_string(id)).c_str());
    Match(id);
  }
  EXPECT_THAT(Emitted(), ::testing::SizeIs(3));
  EXPECT_EQ(Peers().MatchedWriters(), 3U);
  EXPECT_EQ(Dropped(), 0U);
}

TEST_F(PeerEventsTest, AMissOfEachOfAThousandClaimedIdsCrowdsOutNoMatch) {
  for (std::uint32_t id = 100; id < 5000; ++id) Miss(id);
  Find(1, "main/v1");
  Match(1);
  EXPECT_THAT(Emitted(), ::testing::SizeIs(1));
  EXPECT_TRUE(Peers().IsMatched(VehicleId{1}));
}

TEST_F(PeerEventsTest, AfterEventsWereDroppedWhoIsMatchedIsReadAgain) {
  for (std::uint8_t id = 1; id <= 3; ++id) Find(id, ("main/v" + std::to_string(id)).c_str());
  Match(1);
  Match(2);
  Emitted();
  for (int i = 0; i < 2000; ++i) {
    Live(2, false);
    Live(2, true);
  }
  Live(2, false);
  Unmatch(1);
  Match(3);
  ASSERT_GT(Dropped(), 0U);
  const std::vector<QosEvent> emitted = Emitted();
  EXPECT_FALSE(Peers().IsMatched(VehicleId{1}));
  EXPECT_TRUE(Peers().IsMatched(VehicleId{2}));
  EXPECT_TRUE(Peers().IsMatched(VehicleId{3}));
  EXPECT_EQ(Peers().MatchedWriters(), 2U);
  ASSERT_GE(emitted.size(), 3U);
  const auto last = [&](QosEventKind kind) {
    return std::find_if(emitted.rbegin(), emitted.rend(),
                        [kind](const QosEvent& event) { return event.kind == kind; })
        ->vehicle;
  };
  EXPECT_EQ(last(QosEventKind::kMatched), VehicleId{3});
  EXPECT_EQ(last(QosEventKind::kUnmatched), VehicleId{1});
  EXPECT_EQ(last(QosEventKind::kLivelinessLost), VehicleId{2});
  // Once: from then on the events are whole again.
  EXPECT_THAT(Emitted(), ::testing::IsEmpty());
  Unmatch(2);
  EXPECT_THAT(Emitted(), ::testing::SizeIs(1));
}

// Issue 21, number 22: the library gives up watching the deadlines of a reader.
TEST_F(PeerEventsTest, AMissIsToldByTheOwnClockWhereTheLibrarySaysNothing) {
  Find(1, "main/v5");
  Match(1);
  Emitted();
  EXPECT_THAT(MissedAt(10'000), ::testing::IsEmpty()) << "never heard yet";
  Hear(5, 10'000);
  EXPECT_THAT(MissedAt(10'150), ::testing::IsEmpty());
  EXPECT_THAT(MissedAt(10'151), ElementsAre(VehicleId{5}));
  Miss(5);
  EXPECT_THAT(Emitted(), ::testing::IsEmpty()) << "an edge, whichever detects it first";
  EXPECT_THAT(MissedAt(11'000), ::testing::IsEmpty());
  Hear(5, 12'000);
  Miss(5);
  EXPECT_THAT(Emitted(), ::testing::SizeIs(1));
  EXPECT_THAT(MissedAt(12'151), ::testing::IsEmpty());
  Hear(5, 13'000);
  EXPECT_THAT(MissedAt(13'151), ElementsAre(VehicleId{5}));
  Unmatch(1);
  Emitted();
  EXPECT_THAT(MissedAt(20'000), ::testing::IsEmpty());
}

}  // namespace
}  // namespace giveway::link
