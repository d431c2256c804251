// In which order the samples of discovery writers pass the packet filter.
#include "services/link/packet_filter/discovery_order.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>

#include "services/link/packet_filter/packet_filter.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::PacketBytes;
using test::RtpsPacket;

constexpr std::uint32_t kSource = 0x7f000001;
constexpr SteadyTime kStarted = seconds(1000);
constexpr test::PrefixBytes kSpeaking = {1, 15, 5};
constexpr test::PrefixBytes kUnannounced = {1, 15, 4};
constexpr test::PrefixBytes kOurs = {1, 15, 3};
constexpr std::uint32_t kSubscribed = 0x000004c2;
constexpr std::uint32_t kAssertions = 0x000200c2;
constexpr std::uint32_t kAnnouncedWriter = 0x102;
constexpr auto kPassed = PacketDrop::kNone;
constexpr auto kTooFar = PacketDrop::kSequenceJump;
constexpr auto kAhead = static_cast<std::int64_t>(ArrivalWindow::kAhead);

// A filter that knows a participant, and hears its discovery writers.
class DiscoveryOrderTest : public ::testing::Test {
 protected:
  DiscoveryOrderTest() { EXPECT_EQ(Hear(Packet().Announcement(kSpeaking, 1)), kPassed); }

  static RtpsPacket Packet() { return RtpsPacket(kSpeaking); }
  PacketDrop Hear(const RtpsPacket& packet) {
    now_ += milliseconds(1);
    return filter_.Check(packet.Bytes(), kSource, now_).drop;
  }
  // The announcement of one writer, the same under each number.
  PacketDrop Announce(std::int64_t number, std::size_t more_bytes = 0) {
    PacketBytes more;
    if (more_bytes > 0) {
      const auto bytes = static_cast<std::uint16_t>(more_bytes);
      more = {0, 0x40, static_cast<std::uint8_t>(bytes), static_cast<std::uint8_t>(bytes >> 8U)};
      more.resize(4 + more_bytes);
    }
    return Hear(Packet().WriterAnnouncement(kSpeaking, kAnnouncedWriter, number, more));
  }
  PacketDrop Heartbeat(std::int64_t first, std::int64_t last, std::uint32_t count) {
    return Hear(Packet().Heartbeat(test::kPublications, first, last, count));
  }
  // Again: it goes out by another socket too.
  void Acknowledge(std::int64_t first_missing, bool again = false) {
    const RtpsPacket sent = RtpsPacket(kOurs).InfoDst(kSpeaking).AckNack(
        test::kPublications, first_missing, 0, 0, again ? acknacks_ : ++acknacks_);
    ASSERT_TRUE(AcknowledgesDiscovery(sent.Bytes()));
    filter_.HearOwn(sent.Bytes());
  }

  PacketFilter filter_{{.fleet_size = 2, .strangers = 64}};
  SteadyTime now_ = kStarted;
  std::uint32_t acknacks_ = 0;
};

// A writer of publications sent 2, 3, 4 and so on, never 1: the library kept all of it.
TEST_F(DiscoveryOrderTest, AWriterThatHoldsBackItsFirstSampleIsHeardAWhile) {
  int passed = 0;
  for (std::int64_t number = 2; number <= 5000; ++number) {
    const PacketDrop drop = Announce(number);
    EXPECT_TRUE(drop == kPassed || drop == kTooFar);
    passed += drop == kPassed ? 1 : 0;
  }
  EXPECT_EQ(passed, kAhead - 1);
  EXPECT_EQ(Announce(1), kPassed);
  EXPECT_EQ(Announce(kAhead + 1), kPassed);
}

// Who named another reader in a HEARTBEAT moved the bound, and not the library.
TEST_F(DiscoveryOrderTest, WhatNamesAnotherReaderMovesNoBound) {
  constexpr std::uint32_t kAnotherReader = 0x107;
  constexpr std::uint32_t kItsReader = 0x3c7;
  const auto heartbeat = [&](std::uint32_t count, std::uint32_t reader) {
    return Hear(Packet().Heartbeat(test::kPublications, 4001, 4002, count, reader));
  };
  EXPECT_EQ(heartbeat(1, kAnotherReader), kPassed);
  EXPECT_EQ(Announce(4002), kTooFar);
  EXPECT_EQ(heartbeat(2, kItsReader), kPassed);
  EXPECT_EQ(Announce(4002), kPassed);
}

TEST_F(DiscoveryOrderTest, WhatItSendsMeanwhileIsBoundedByItsBytesToo) {
  int passed = 0;
  for (std::int64_t number = 2; number <= 200; ++number) {
    passed += Announce(number, 8000) == kPassed ? 1 : 0;
  }
  EXPECT_LE(passed, 32) << "256 KiB";
  EXPECT_GE(passed, 31);
  for (std::int64_t number = 1; number <= 200; ++number) {
    EXPECT_EQ(Announce(number, 8000), kPassed) << "in its order all is heard";
  }
}

TEST_F(DiscoveryOrderTest, ALongHistoryPassesInItsOrder) {
  for (std::int64_t number = 1; number <= 5000; ++number) {
    ASSERT_EQ(Announce(number), kPassed) << number;
  }
  EXPECT_EQ(Announce(5000), kPassed) << "twice";
  EXPECT_EQ(Announce(7), kPassed) << "sent again for another";
}

// A world after weeks: of what it announced most has ended.
TEST_F(DiscoveryOrderTest, ALateJoinerHearsASparseHistory) {
  EXPECT_EQ(Heartbeat(3, 90'000, 1), kPassed);
  EXPECT_EQ(Announce(3), kPassed);
  EXPECT_EQ(Hear(Packet().Gap(test::kPublications, 4, 89'000)), kPassed);
  EXPECT_EQ(Announce(89'000), kPassed);
  EXPECT_EQ(Hear(Packet().Gap(test::kPublications, 89'001, 90'000, 32)), kPassed);
  EXPECT_EQ(Announce(90'000), kPassed);
}

TEST_F(DiscoveryOrderTest, ADiscoveryServerWhoseHistoryStartsLateIsHeardFromThereOn) {
  EXPECT_EQ(Heartbeat(4001, 4002, 1), kPassed);
  EXPECT_EQ(Announce(4002), kPassed);
  EXPECT_EQ(Announce(4001), kPassed);
  EXPECT_EQ(Announce(4003), kPassed);
}

TEST_F(DiscoveryOrderTest, AfterALossWhatWasTooFarIsTakenWhenItIsSentAgain) {
  for (std::int64_t number = 1; number <= 400; ++number) {
    if (number == 11) continue;  // lost
    EXPECT_EQ(Announce(number), number < 11 + kAhead ? kPassed : kTooFar) << number;
  }
  EXPECT_EQ(Announce(11), kPassed);
  for (std::int64_t number = 11 + kAhead; number <= 400; ++number) {
    EXPECT_EQ(Announce(number), kPassed) << number;
  }
}

// Whatever was missed here, by shared memory or in a flood, the library knows where it stands.
TEST_F(DiscoveryOrderTest, WhatTheLibraryAcknowledgesHasCome) {
  EXPECT_EQ(Announce(5001), kTooFar);
  Acknowledge(1);
  EXPECT_EQ(Announce(5001), kTooFar);
  Acknowledge(5001);
  EXPECT_EQ(Announce(5001), kPassed);
  EXPECT_EQ(Hear(Packet().Data(kSubscribed, 5001, PacketBytes{0, 3, 0, 0, 1, 0, 0, 0})), kTooFar)
      << "of another writer it said nothing";
}

TEST_F(DiscoveryOrderTest, NothingOfADroppedPacketIsNoted) {
  const RtpsPacket dropped = Packet()
                                 .Gap(test::kPublications, 1, 1001)
                                 .Data(kAnnouncedWriter, std::int64_t{1} << 40U, PacketBytes(8));
  EXPECT_EQ(Hear(dropped), PacketDrop::kSequenceJump);
  EXPECT_EQ(Announce(1001), kTooFar);
  EXPECT_EQ(Hear(Packet().Gap(test::kPublications, 1, 1001)), kPassed);
  EXPECT_EQ(Announce(1001), kPassed);
}

TEST_F(DiscoveryOrderTest, WhatTheLibraryDoesNotReadIsNotNoted) {
  Acknowledge(1);
  EXPECT_EQ(Hear(Packet().InfoDst(kUnannounced).Gap(test::kPublications, 1, 1001)), kPassed);
  EXPECT_EQ(Announce(1001), kTooFar) << "went to another";
  EXPECT_EQ(Heartbeat(1, 1, 9), kPassed);
  EXPECT_EQ(Heartbeat(1001, 1001, 9), kPassed);
  EXPECT_EQ(Announce(1001), kTooFar) << "a heartbeat that came before";
  EXPECT_EQ(Heartbeat(1001, 1001, 10), kPassed);
  EXPECT_EQ(Announce(1001), kPassed);
}

// The library notes each number by itself: 167 GAPs of 100 000 numbers in one packet, 0.7 GB.
TEST_F(DiscoveryOrderTest, AGapBeyondAHoleIsLimited) {
  constexpr std::int64_t kMost = ArrivalWindow::kGapAhead;
  const auto gap = [&](std::int64_t start, std::int64_t base, std::uint32_t bits = 0) {
    return Hear(Packet().Gap(test::kPublications, start, base, bits));
  };
  EXPECT_EQ(gap(2, 100'001), kTooFar);
  EXPECT_EQ(gap(3, kMost + 2), kTooFar);
  EXPECT_EQ(gap(kMost - 100, kMost - 99, 256), kTooFar);
  EXPECT_EQ(gap(3, kMost + 1), kPassed);
  EXPECT_EQ(gap(1, 100'001), kPassed);
  EXPECT_EQ(gap(100'001, 200'001), kPassed);
}

// 3.1.2 does not read it.
TEST_F(DiscoveryOrderTest, AGapWithoutARangeMovesNoBound) {
  PacketBytes gap = Packet().Gap(test::kPublications, 1, 1, 256).Bytes();
  std::fill(gap.end() - 32, gap.end(), std::uint8_t{0xff});
  EXPECT_EQ(filter_.Check(gap, kSource, now_).drop, kPassed);
  EXPECT_EQ(Announce(kAhead + 1), kTooFar);
}

// Regression: the bound stayed where the former participant's was, and held nothing.
TEST_F(DiscoveryOrderTest, AfterAFarewellItsWritersStartAgain) {
  EXPECT_EQ(Hear(Packet().Gap(test::kPublications, 1, 100'001)), kPassed);
  EXPECT_EQ(Announce(100'001), kPassed);
  now_ += milliseconds(1);
  EXPECT_EQ(filter_.Check(FarewellOf(kSpeaking, 2), kSource, now_).drop, kPassed);
  EXPECT_EQ(Announce(100'002), kTooFar);
  EXPECT_EQ(Announce(1), kPassed);
}

// What was handed on and the library did not take, or a participant that it has dropped.
TEST_F(DiscoveryOrderTest, WhatTheLibraryDoesNotAcknowledgeTwiceHasNotCome) {
  EXPECT_EQ(Hear(Packet().Gap(test::kPublications, 1, 100'001)), kPassed);
  Acknowledge(2);
  EXPECT_EQ(Announce(100'001), kPassed) << "it may come meanwhile";
  Acknowledge(2, true);
  EXPECT_EQ(Announce(100'001), kPassed) << "the same, by another socket";
  Acknowledge(2);
  EXPECT_EQ(Announce(100'002), kTooFar);
  EXPECT_EQ(Announce(kAhead + 2), kTooFar);
  EXPECT_EQ(Announce(kAhead + 1), kPassed);
  EXPECT_EQ(Announce(2), kPassed);
}

PacketBytes Assertion(const test::PrefixBytes& participant, std::uint8_t kind,
                      std::size_t data_bytes = 0) {
  PacketBytes payload = {0, 3, 0, 0};
  payload.insert(payload.end(), participant.begin(), participant.end());
  payload.insert(payload.end(), {0, 0, 0, kind, 0, 0, 0, 0});
  payload.resize(payload.size() + data_bytes);
  return payload;
}

// Under each other key the library kept one more, and compared each new one with all of them.
TEST_F(DiscoveryOrderTest, AnAssertionOfLivelinessIsOfItsSender) {
  std::int64_t number = 0;
  const auto hear = [&](const PacketBytes& payload) {
    return Hear(Packet().Data(kAssertions, ++number, payload));
  };
  EXPECT_EQ(hear(Assertion(kSpeaking, 1)), kPassed);
  EXPECT_EQ(hear(Assertion(kSpeaking, 2)), kPassed);
  EXPECT_EQ(hear(Assertion(kSpeaking, 1, 16)), kPassed) << "a vendor's own data";
  EXPECT_EQ(hear(Assertion(kUnannounced, 1)), PacketDrop::kMalformed);
  EXPECT_EQ(hear(Assertion(kSpeaking, 4)), PacketDrop::kMalformed);
  EXPECT_EQ(hear(Assertion(kSpeaking, 1, 1000)), PacketDrop::kMalformed);
  EXPECT_EQ(hear({0, 3, 0, 0}), PacketDrop::kMalformed);
  EXPECT_EQ(Hear(Packet().DataFrag(kAssertions, ++number, 1, 1, 1000, 2184, 1000)),
            PacketDrop::kFragmentedAnnouncement);
}

TEST_F(DiscoveryOrderTest, TheHashOfAnAssertionsKeyIsItsKey) {
  const auto with_hash = [](const test::PrefixBytes& participant, bool has_payload) {
    PacketBytes body(20);
    body[2] = 16;  // octets to the inline QoS
    body[9] = 2;   // the writer
    body[11] = 0xc2;
    body[16] = 1;  // the number's low half
    body.insert(body.end(), {0x70, 0, 16, 0});
    body.insert(body.end(), participant.begin(), participant.end());
    body.insert(body.end(), {0, 0, 0, 1, 1, 0, 0, 0});
    const PacketBytes payload = Assertion(kSpeaking, 1);
    if (has_payload) body.insert(body.end(), payload.begin(), payload.end());
    return Packet().Add(0x15, has_payload ? 0x06 : 0x02, body);
  };
  EXPECT_EQ(Hear(with_hash(kSpeaking, true)), kPassed);
  EXPECT_EQ(Hear(with_hash(kUnannounced, true)), PacketDrop::kMalformed);
  EXPECT_EQ(Hear(with_hash(kSpeaking, false)), kPassed);
  EXPECT_EQ(Hear(with_hash(kUnannounced, false)), PacketDrop::kMalformed);
}

// One that the table of participants does not know the library mostly does not know either.
TEST_F(DiscoveryOrderTest, OfUnknownParticipantsLittlePasses) {
  int passed = 0;
  for (std::int64_t number = 1; number <= 5000; ++number) {
    RtpsPacket packet(kUnannounced);
    packet.Data(kAssertions, number, Assertion(kUnannounced, 1));
    passed += Hear(packet) == kPassed ? 1 : 0;
  }
  EXPECT_LE(passed, 1024 + 5 * 16 + 1);
}

}  // namespace
}  // namespace giveway::link
