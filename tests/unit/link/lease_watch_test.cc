// Which participants the lease watch drops, and when: by packets as participants send them.
#include "services/link/packet_filter/lease_watch.h"

#include <gtest/gtest.h>

#include <chrono>

#include "services/link/packet_filter/packet_filter.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::RtpsPacket;

constexpr SteadyTime kFirst = seconds(1000);
constexpr test::PrefixBytes kDying = {1, 15, 7};
constexpr test::PrefixBytes kLiving = {1, 15, 8};
constexpr std::uint32_t kLease_s = 10;
constexpr Nanoseconds kNineTenths = seconds(9);

bool Announce(LeaseWatch& watch, const test::PrefixBytes& by, SteadyTime now,
              std::int64_t number = 1, std::uint32_t lease_s = kLease_s) {
  return watch.Hear(RtpsPacket(by).InfoTs().Announcement(by, number, lease_s).Bytes(), now);
}

TEST(LeaseWatch, TakesLeaveOnceOfOneThatIsSilentForNearlyItsLease) {
  LeaseWatch watch;
  EXPECT_TRUE(Announce(watch, kDying, kFirst));
  EXPECT_FALSE(watch.TakeFarewell(kFirst + kNineTenths - milliseconds(1)).has_value());
  EXPECT_TRUE(watch.TakeFarewell(kFirst + kNineTenths).has_value());
  EXPECT_FALSE(watch.TakeFarewell(kFirst + kNineTenths).has_value());
  EXPECT_EQ(watch.Participants(), 0U);
}

TEST(LeaseWatch, IsSatisfiedWithWhateverAParticipantSends) {
  LeaseWatch watch;
  Announce(watch, kDying, kFirst);
  const auto sample = RtpsPacket(kDying).Data(test::kUserWriter, 1, test::PacketBytes(8));
  EXPECT_FALSE(watch.Hear(sample.Bytes(), kFirst + seconds(8))) << "announces no participant";
  EXPECT_FALSE(watch.TakeFarewell(kFirst + seconds(8) + kNineTenths - milliseconds(1)));
  EXPECT_TRUE(watch.TakeFarewell(kFirst + seconds(8) + kNineTenths));
}

// The library, to which no lease is longer than 120 s, had dropped such a one before its farewell.
TEST(LeaseWatch, TakesLeaveOfOneWithALongLeaseBeforeTheLibraryDropsIt) {
  for (const std::uint32_t lease_s : {121U, 1000U, 0x7fff'ffffU}) {
    LeaseWatch watch;
    Announce(watch, kDying, kFirst, 1, lease_s);
    EXPECT_FALSE(watch.TakeFarewell(kFirst + seconds(107)).has_value());
    EXPECT_TRUE(watch.TakeFarewell(kFirst + seconds(108)).has_value()) << lease_s;
  }
}

TEST(LeaseWatch, NamesTheOneThatDiedNotTheOneThatIsHeard) {
  LeaseWatch watch;
  Announce(watch, kDying, kFirst, 41);
  Announce(watch, kLiving, kFirst);
  Announce(watch, kLiving, kFirst + kNineTenths);
  const auto farewell = watch.TakeFarewell(kFirst + kNineTenths);
  ASSERT_TRUE(farewell.has_value());
  EXPECT_TRUE(std::equal(kDying.begin(), kDying.end(), farewell->begin() + 8));
  SubmessageWalk walk(*farewell);
  Submessage data;
  ASSERT_TRUE(walk.Next(&data));
  EXPECT_TRUE(walk.IsAtEnd());
  EXPECT_TRUE(IsAnnouncement(data));
  EXPECT_EQ(AnnouncementNumber(data), 42) << "the library skips numbers that it has seen";
}

TEST(LeaseWatch, SendsWhatAnHonestParticipantWouldSend) {
  LeaseWatch watch;
  Announce(watch, kDying, kFirst);
  const auto farewell = watch.TakeFarewell(kFirst + kNineTenths);
  ASSERT_TRUE(farewell.has_value());
  PacketFilter filter({});
  EXPECT_EQ(filter.Check(*farewell, 0x7f000001, kFirst).drop, PacketDrop::kNone);
  LeaseWatch another;
  Announce(another, kDying, kFirst);
  EXPECT_TRUE(another.Hear(*farewell, kFirst));
  EXPECT_EQ(another.Participants(), 0U) << "a participant that left has none";
}

TEST(ShortenLeases, LeavesNoneLongerThanItMayBe) {
  for (const bool little : {true, false}) {
    const auto of = [little](std::uint32_t lease_s) {
      return RtpsPacket(kDying, test::kEProsima, little)
          .InfoTs()
          .Announcement(kDying, 1, lease_s)
          .Bytes();
    };
    const auto shortened = [&of](std::uint32_t lease_s) {
      test::PacketBytes packet = of(lease_s);
      ShortenLeases(packet, seconds(120));
      return packet;
    };
    EXPECT_EQ(shortened(119), of(119));
    EXPECT_EQ(shortened(121), of(120));
    EXPECT_EQ(shortened(0x7fff'ffff), of(120)) << "endless";
  }
}

TEST(LeaseWatch, LeavesToAServerWhomItSpeaksFor) {
  LeaseWatch watch;
  watch.Hear(RtpsPacket(kLiving).Announcement(kDying, 1, kLease_s).Bytes(), kFirst);
  EXPECT_EQ(watch.Participants(), 0U);
}

TEST(LeaseWatch, ForgetsTheLongestSilentOfTooMany) {
  LeaseWatch watch;
  SteadyTime now = kFirst;
  Announce(watch, kLiving, now);
  for (std::uint32_t i = 0; i < 2 * LeaseWatch::kMostParticipants; ++i) {
    test::PrefixBytes stranger = {1, 15};
    stranger[4] = static_cast<std::uint8_t>(i);
    stranger[5] = static_cast<std::uint8_t>(i >> 8U);
    now += milliseconds(1);
    Announce(watch, stranger, now);
    Announce(watch, kLiving, now += milliseconds(1));
  }
  EXPECT_EQ(watch.Participants(), LeaseWatch::kMostParticipants);
}

}  // namespace
}  // namespace giveway::link
