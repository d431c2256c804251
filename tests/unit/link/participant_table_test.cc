// How many participants, and how many endpoints of each, the packet filter lets the library know.
#include "services/link/packet_filter/participant_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "services/link/packet_filter/packet_filter.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::RtpsPacket;

constexpr std::uint32_t kLoopback = 0x7f000001;
constexpr SteadyTime kMet = seconds(1000);
constexpr test::PrefixBytes kAnnouncingWorld = {1, 15, 8};

test::PrefixBytes Numbered(std::uint32_t number) {
  return {8, 8, static_cast<std::uint8_t>(number >> 8U), static_cast<std::uint8_t>(number), 2};
}

// A participant that announces itself, and then writers, each with an id of its own.
class Announcer {
 public:
  Announcer(const PacketFilterOptions& options, const test::PrefixBytes& prefix)
      : filter_(options), prefix_(prefix) {
    EXPECT_EQ(DropOf(RtpsPacket(prefix_).Announcement(prefix_, 1)), PacketDrop::kNone);
    EXPECT_EQ(DropOf(RtpsPacket(prefix_).Heartbeat(test::kPublications, 1, 1, 1)),
              PacketDrop::kNone);
  }
  PacketDrop Announce(std::uint32_t writer) {
    now_ += milliseconds(1);
    return Sent(RtpsPacket(prefix_).WriterAnnouncement(prefix_, writer << 8U | 2, number_ + 1));
  }
  PacketDrop End(std::uint32_t writer) {
    return Sent(RtpsPacket(prefix_).WriterEnd(prefix_, writer << 8U | 2, number_ + 1));
  }
  // How many of so many writers that it had not announced before.
  int AnnounceNew(int writers) {
    int handed_on = 0;
    for (int i = 0; i < writers; ++i) {
      const PacketDrop drop = Announce(next_++);
      EXPECT_TRUE(drop == PacketDrop::kNone || drop == PacketDrop::kTooManyEndpoints);
      handed_on += drop == PacketDrop::kNone ? 1 : 0;
    }
    return handed_on;
  }

 private:
  // What is dropped leaves no hole behind: its writer would send it again.
  PacketDrop Sent(const RtpsPacket& packet) {
    const PacketDrop drop = DropOf(packet);
    number_ += drop == PacketDrop::kNone ? 1 : 0;
    return drop;
  }
  PacketDrop DropOf(const RtpsPacket& packet) {
    return filter_.Check(packet.Bytes(), kLoopback, now_).drop;
  }

  PacketFilter filter_;
  test::PrefixBytes prefix_;
  SteadyTime now_ = kMet;
  std::int64_t number_ = 0;
  std::uint32_t next_ = 1;
};

// Regression: one participant announced writers without end, and the memory of each process was
// gone in seconds.
TEST(ParticipantTable, EndpointsOfOneParticipantAreLimited) {
  Announcer stranger({.fleet_size = 2, .strangers = 64}, Numbered(1));
  const int handed_on = stranger.AnnounceNew(5000);  // in 5 s
  EXPECT_GE(handed_on, 32 + 64 * 8 + 2 * 16);
  EXPECT_LE(handed_on, 32 + 64 * 8 + 2 * 16 + 5 * 4 + 1);
  for (std::uint32_t known = 1; known <= 32; ++known) {
    EXPECT_EQ(stranger.Announce(known), PacketDrop::kNone) << "sent again, or with other QoS";
  }
}

TEST(ParticipantTable, AWorldAnnouncesWhatItHasForEachVehicleAndAfterARestartAgain) {
  constexpr int kWriters = 10 + 5 * 200;
  const PacketFilterOptions options{.fleet_size = 200, .strangers = 64};
  EXPECT_EQ(Announcer(options, kAnnouncingWorld).AnnounceNew(3 * kWriters), 3 * kWriters);
  const PacketFilterOptions of_a_tool{.fleet_size = 32, .strangers = 256};
  EXPECT_EQ(Announcer(of_a_tool, kAnnouncingWorld).AnnounceNew(kWriters), kWriters);
}

// A world makes endpoints for each vehicle that comes, and ends them when it leaves: for weeks.
TEST(ParticipantTable, EndpointsThatHaveEndedCountNoMore) {
  Announcer world({.fleet_size = 2, .strangers = 1}, kAnnouncingWorld);
  EXPECT_EQ(world.AnnounceNew(60), 60);
  for (std::uint32_t i = 100; i < 10'000; ++i) {
    ASSERT_EQ(world.Announce(i), PacketDrop::kNone) << i;
    ASSERT_EQ(world.End(i), PacketDrop::kNone) << i;
  }
}

// What one participant has in excess takes nothing from the others' own.
TEST(ParticipantTable, EachParticipantHasEndpointsOfItsOwn) {
  ParticipantTable table(0, 0);
  const auto endpoint = [](std::uint32_t participant, std::uint8_t number) {
    EndpointGuid guid{};
    std::ranges::copy(Numbered(participant), guid.begin());
    guid[14] = number;
    return guid;
  };
  EXPECT_FALSE(table.MayAdd(endpoint(1, 1), kMet)) << "not announced";
  EXPECT_FALSE(table.MayJoin(Numbered(1), kMet));
  table = ParticipantTable(2, 0);
  for (std::uint32_t participant = 1; participant <= 2; ++participant) {
    ASSERT_TRUE(table.MayJoin(Numbered(participant), kMet));
  }
  for (std::uint8_t i = 0; i < 200; ++i) table.MayAdd(endpoint(1, i), kMet);
  EXPECT_FALSE(table.MayAdd(endpoint(1, 200), kMet));
  for (std::uint8_t i = 0; i < 32; ++i) EXPECT_TRUE(table.MayAdd(endpoint(2, i), kMet));
  EXPECT_FALSE(table.MayAdd(endpoint(2, 32), kMet));
  EXPECT_TRUE(table.MayAdd(endpoint(2, 32), kMet + seconds(1))) << "afterwards it may have more";
}

// Regression: a DATA that names the entity of its participant as its writer made the participant
// known, and its announcement was not counted.
TEST(ParticipantTable, AStrangerIsNotKnownByWhatItSentBefore) {
  PacketFilter filter({.fleet_size = 0, .strangers = 8});
  int let_in = 0;
  for (std::uint32_t i = 0; i < 100; ++i) {
    const test::PrefixBytes prefix = Numbered(i);
    filter.Check(RtpsPacket(prefix).Data(0x000001c1, 1, test::PacketBytes(8)).Bytes(), kLoopback,
                 kMet);
    const RtpsPacket announcement = RtpsPacket(prefix).Announcement(prefix, 1);
    const PacketDrop drop = filter.Check(announcement.Bytes(), kLoopback, kMet).drop;
    let_in += drop == PacketDrop::kNone ? 1 : 0;
  }
  EXPECT_EQ(let_in, 8);
}

TEST(ParticipantTable, StrangersWithoutEndDoNotTakeThePlaceOfOneThatIsHeard) {
  ParticipantTable table(64, 2);
  SteadyTime now = kMet;
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(table.MayJoin(kAnnouncingWorld, now));
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    now += milliseconds(250);
    EXPECT_TRUE(table.MayJoin(Numbered(i), now)) << "four a second may";
    EXPECT_TRUE(i % 200 != 0 || table.MayJoin(kAnnouncingWorld, now));
  }
  EXPECT_LE(table.Participants(), 1024U + 2 * 2);
  std::uint32_t next = 20'000;
  while (table.MayJoin(Numbered(next), now)) ASSERT_LT(++next, 20'100U);
  EXPECT_TRUE(table.MayJoin(kAnnouncingWorld, now));
}

// Regression: after as many killed participants as the table holds, newcomers had each other's
// place alone, and each announcement of one took another turn.
TEST(ParticipantTable, ParticipantsThatAreDeadGiveWayToNewcomers) {
  ParticipantTable table(64, 2);
  SteadyTime now = kMet;
  const auto announce = [&](std::uint32_t from, std::uint32_t to) {
    bool may = true;
    for (std::uint32_t i = from; i < to; ++i) may = table.MayJoin(Numbered(i), now) && may;
    return may;
  };
  for (std::uint32_t killed = 0; killed < 1100; ++killed) {
    for (int i = 0; i < 16; ++i) announce(killed, killed + 1);
    now += milliseconds(250);
  }
  now += kLongestLease;
  EXPECT_TRUE(announce(2000, 2064)) << "64 at once";
  EXPECT_TRUE(announce(2000, 2064)) << "which are known now";
}

TEST(ParticipantTable, AParticipantThatSaidFarewellGivesWayAndReturnsFreely) {
  PacketFilter filter({.fleet_size = 0, .strangers = 64});
  SteadyTime now = kMet;
  const auto announce = [&](std::uint32_t i) {
    const RtpsPacket packet = RtpsPacket(Numbered(i)).Announcement(Numbered(i), 1);
    return filter.Check(packet.Bytes(), kLoopback, now).drop == PacketDrop::kNone;
  };
  for (std::uint32_t i = 0; i < 1024; ++i) {
    ASSERT_TRUE(announce(i));
    now += milliseconds(250);
  }
  for (std::uint32_t i = 0; i < 1024; ++i) {
    for (int times = 0; times < 16; ++times) ASSERT_TRUE(announce(i));
    now += milliseconds(1);
  }
  const auto end = [&](std::uint32_t i) {
    return filter.Check(FarewellOf(Numbered(i), 2), kLoopback, now).drop;
  };
  EXPECT_EQ(end(1022), PacketDrop::kNone);
  EXPECT_EQ(end(1023), PacketDrop::kNone);
  EXPECT_TRUE(filter.Participants().Knows(Numbered(1023)));
  for (int times = 0; times < 16; ++times) EXPECT_TRUE(announce(1023)) << "a forged farewell";
  EXPECT_TRUE(announce(2000));
  EXPECT_FALSE(filter.Participants().Knows(Numbered(1022)));
  EXPECT_TRUE(filter.Participants().Knows(Numbered(1023)));
  EXPECT_TRUE(filter.Participants().Knows(Numbered(0)));
}

}  // namespace
}  // namespace giveway::link
