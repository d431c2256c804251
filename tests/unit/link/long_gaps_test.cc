// GAPs of more numbers than the library may step through.
#include <gtest/gtest.h>

#include <cstdint>

#include "services/link/packet_filter/packet_filter.h"
#include "services/link/packet_filter/submessage_check.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using test::PacketBytes;
using test::RtpsPacket;

constexpr std::uint32_t kFromHere = 0x7f000001;
constexpr SteadyTime kLongAfter = std::chrono::seconds(1000);
constexpr test::PrefixBytes kOldWriter = {1, 15, 9};

RtpsPacket FromOld(bool little) { return RtpsPacket(kOldWriter, test::kEProsima, little); }

// CVE-2025-64438. And a regression: what stood behind a long GAP of an old writer was dropped with
// it.
TEST(LongGaps, AreShortenedAndWhatStandsBehindThemIsHandedOn) {
  const auto verdict_of = [](const PacketBytes& packet) {
    return PacketFilter(PacketFilterOptions{}).Check(packet, kFromHere, kLongAfter);
  };
  const auto drop_of = [&](const RtpsPacket& packet) { return verdict_of(packet.Bytes()).drop; };
  const auto shortened = [&](const RtpsPacket& packet) {
    PacketBytes bytes = packet.Bytes();
    const PacketVerdict verdict = verdict_of(bytes);
    EXPECT_EQ(verdict.drop, PacketDrop::kNone);
    EXPECT_TRUE(verdict.has_long_gaps);
    ShortenGaps(bytes);
    EXPECT_FALSE(verdict_of(bytes).has_long_gaps);
    return bytes;
  };
  for (const bool little : {true, false}) {
    const auto gap = [&](std::int64_t start, std::int64_t base) {
      return FromOld(little).Gap(test::kUserWriter, start, base);
    };
    EXPECT_FALSE(verdict_of(gap(1, 1 + kLongestGap).Bytes()).has_long_gaps);
    const auto with_heartbeat = [](RtpsPacket packet) {
      return packet.Heartbeat(test::kUserWriter, 1, 200'000, 1);
    };
    EXPECT_EQ(shortened(with_heartbeat(gap(1, 2 + kLongestGap))),
              with_heartbeat(gap(1, 1 + kLongestGap)).Bytes());
    EXPECT_EQ(shortened(gap(1, 60'001).Gap(test::kUserWriter, 60'001, 120'001)),
              gap(1, 60'001).Gap(test::kUserWriter, 60'001, 1 + kLongestGap).Bytes());
    const PacketBytes with_bits =
        shortened(FromOld(little).Gap(test::kUserWriter, 1, 2 + kLongestGap, 64));
    EXPECT_EQ(with_bits[20 + 4 + 24] + with_bits[20 + 4 + 27], 0) << "of which none is left";
    EXPECT_EQ(drop_of(gap(1, 4'000'000'000)), PacketDrop::kSequenceJump);
    EXPECT_EQ(drop_of(FromOld(little).Gap(test::kPublications, 1, 2 + kLongestGap)),
              PacketDrop::kRangeTooLong);
    // The window of the second had counted what was then cut off.
    EXPECT_EQ(drop_of(gap(1, 2 + kLongestGap).Gap(test::kPublications, 1, 1 + kLongestGap)),
              PacketDrop::kRangeTooLong);
  }
}

}  // namespace
}  // namespace giveway::link
