// Whom an event of a reader is told to be about. No participant is made: the library's callbacks
// are called by hand, in the orders its threads call them.
#include "services/link/peer_events.h"

#include <gmock/gmock.h>

#include <thread>

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
  // The vehicles that are told to be incompatible.
  std::vector<VehicleId> Unfit() {
    std::vector<QosEvent> told;
    const auto events = events_.Take();
    names_.Update();
    peers_.Translate(events, SteadyTime{0}, told);
    std::vector<VehicleId> unfit;
    for (const QosEvent& event : told) {
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
  EXPECT_THAT(Unfit(), ElementsAre(VehicleId{7}, VehicleId{5}, kNobody));
}

TEST_F(PeerEventsTest, NamesNobodyForAWriterOfAnotherArea) {
  Find(1, "north/v5");
  Refuse();
  EXPECT_THAT(Unfit(), ElementsAre(kNobody));
}

}  // namespace
}  // namespace giveway::link
