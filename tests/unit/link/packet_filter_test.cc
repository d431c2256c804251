// What the packet filter passes and drops: submessages by themselves first, then numbers and
// announcements by what came before.
#include "services/link/packet_filter/packet_filter.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "services/link/packet_filter/submessage_check.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::PacketBytes;
using test::RtpsPacket;

constexpr std::uint32_t kHere = 0x7f000001;
constexpr std::uint32_t kElsewhere = 0x0a000001;
constexpr std::int64_t kFar = 4'000'000'000;
constexpr SteadyTime kStart = seconds(1000);
constexpr std::int64_t kSlack = 8;  // of a writer at 20 Hz that sends samples alone
constexpr test::PrefixBytes kPeer = {1, 15, 7};
const PacketBytes kPayload = {0, 1, 0, 0, 1, 2, 3, 4};

RtpsPacket FromPeer(bool little = true) { return RtpsPacket(kPeer, test::kEProsima, little); }

PacketDrop DropOf(const PacketBytes& packet, SteadyTime now, PacketFilter* filter) {
  return filter->Check(packet, kHere, now).drop;
}

PacketDrop Alone(const PacketBytes& packet, const PacketFilterOptions& options = {}) {
  return PacketFilter(options).Check(packet, kHere, kStart).drop;
}
PacketDrop Alone(const RtpsPacket& packet) { return Alone(packet.Bytes()); }

PacketBytes FromAnotherVendor() {
  return RtpsPacket(kPeer, test::kCyclone).Add(0x81, 0, PacketBytes(8)).InfoTs().Bytes();
}

TEST(PacketFilter, HandsOnWhatFastDdsSends) {
  for (const bool little : {true, false}) {
    EXPECT_EQ(Alone(FromPeer(little).InfoTs().Data(test::kUserWriter, 1, kPayload)),
              PacketDrop::kNone);
    EXPECT_EQ(Alone(FromPeer(little).InfoDst(kPeer).Heartbeat(test::kUserWriter, 1, 0, 1)),
              PacketDrop::kNone);
    EXPECT_EQ(Alone(FromPeer(little).Gap(test::kUserWriter, 3, 5, 40)), PacketDrop::kNone);
    EXPECT_EQ(Alone(FromPeer(little).AckNack(test::kUserWriter, 0, 0, 0)), PacketDrop::kNone);
    EXPECT_EQ(Alone(FromPeer(little).AckNack(test::kUserWriter, 9, 256, 8)), PacketDrop::kNone);
    EXPECT_EQ(Alone(FromPeer(little).Announcement(kPeer, 1)), PacketDrop::kNone);
    EXPECT_EQ(Alone(FromPeer(little).DataFrag(test::kUserWriter, 1, 1, 1, 1000, 2184, 1000)),
              PacketDrop::kNone);
    EXPECT_EQ(Alone(FromPeer(little).DataFrag(test::kUserWriter, 1, 3, 1, 1000, 2184, 184)),
              PacketDrop::kNone);
  }
}

TEST(PacketFilter, HandsOnAnotherVendorsOwnKindsWhichTheLibraryDoesNotRead) {
  EXPECT_EQ(Alone(FromAnotherVendor()), PacketDrop::kNone);
}

TEST(PacketFilter, DropsWhatIsNoRtps) {
  EXPECT_EQ(Alone(PacketBytes{}), PacketDrop::kNotRtps);
  EXPECT_EQ(Alone(PacketBytes(20, 'x')), PacketDrop::kNotRtps);
  PacketBytes packet = FromPeer().InfoTs().Bytes();
  packet[4] = 3;  // its major version
  EXPECT_EQ(Alone(packet), PacketDrop::kNotRtps);
}

// Issue 25: one multicast of 84 bytes ended the world and every vehicle.
TEST(PacketFilter, DropsStatisticsThatTheLibraryWouldDieOf) {
  PacketBytes packet = FromPeer().Statistics().Bytes();
  packet.resize(84);
  EXPECT_EQ(Alone(packet), PacketDrop::kStatistics);
  EXPECT_EQ(Alone(FromPeer().Statistics()), PacketDrop::kStatistics) << "nothing else in it";
  EXPECT_EQ(Alone(FromPeer().InfoTs().Add(0x80, 0, PacketBytes(55))), PacketDrop::kStatistics);
  EXPECT_EQ(Alone(FromPeer().InfoTs().Add(0x80, 0, PacketBytes(56), 0)), PacketDrop::kStatistics);
  EXPECT_EQ(Alone(FromPeer().InfoTs().Statistics().InfoTs()), PacketDrop::kStatistics);
}

TEST(PacketFilter, CutsOffTheStatisticsThatEndASoundPacket) {
  const PacketBytes without = FromPeer().InfoTs().Data(test::kUserWriter, 1, kPayload).Bytes();
  const PacketBytes with =
      FromPeer().InfoTs().Data(test::kUserWriter, 1, kPayload).Statistics().Bytes();
  const PacketVerdict verdict = PacketFilter({}).Check(with, kHere, kStart);
  EXPECT_EQ(verdict.drop, PacketDrop::kNone);
  EXPECT_EQ(verdict.bytes, without.size());
}

TEST(PacketFilter, DropsKindsThatNobodySends) {
  for (const int kind : {0x00, 0x02, 0x0a, 0x14, 0x17, 0x30, 0x34, 0x7f, 0x81, 0xff}) {
    EXPECT_EQ(Alone(FromPeer().Add(static_cast<std::uint8_t>(kind), 0, PacketBytes(32))),
              PacketDrop::kUnknownKind)
        << kind;
  }
}

TEST(PacketFilter, HandsOnSecureKindsWhereSecurityIsOn) {
  for (std::uint8_t kind = 0x30; kind <= 0x34; ++kind) {
    const PacketBytes packet = FromPeer().Add(kind, 0, PacketBytes(32)).Bytes();
    EXPECT_EQ(Alone(packet, {.secured = true}), PacketDrop::kNone);
  }
}

TEST(PacketFilter, DropsListsThatEndBeyondWhatHoldsThem) {
  EXPECT_EQ(Alone(FromPeer().AckNack(test::kUserWriter, 1, 64, 1)), PacketDrop::kListTooLong);
  EXPECT_EQ(Alone(FromPeer().AckNack(test::kUserWriter, 1, 257, 9)), PacketDrop::kListTooLong);
  EXPECT_EQ(Alone(FromPeer().Gap(test::kUserWriter, 1, 2, 257)), PacketDrop::kListTooLong);
  EXPECT_EQ(Alone(FromPeer().Add(0x0f, 0, PacketBytes(24, 0xff))), PacketDrop::kListTooLong);
  EXPECT_EQ(Alone(FromPeer().Add(0x01, 0, PacketBytes(4), 8)), PacketDrop::kListTooLong);
  PacketBytes qos_without_end(28);
  qos_without_end[2] = 16;  // octets to the inline QoS
  qos_without_end[19] = 0;  // the number's low half, little-endian
  qos_without_end[16] = 1;
  qos_without_end[20] = 0x70;
  qos_without_end[22] = 0xf0;
  EXPECT_EQ(Alone(FromPeer().Add(0x15, 0x02, qos_without_end)), PacketDrop::kListTooLong);
}

TEST(PacketFilter, DropsSubmessagesThatContradictThemselves) {
  EXPECT_EQ(Alone(FromPeer().Data(test::kUserWriter, 0, kPayload)), PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().Data(test::kUserWriter, -1, kPayload)), PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().Data(test::kUserWriter, 1, PacketBytes(3))), PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().Heartbeat(test::kUserWriter, 0, 5, 1)), PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().Heartbeat(test::kUserWriter, 7, 5, 1)), PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().Gap(test::kUserWriter, 5, 4)), PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().Add(0x0e, 0, PacketBytes(8))), PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().Add(0x09, 0, PacketBytes(4))), PacketDrop::kMalformed);
}

// Of fragment 0 the library read 4 GB behind the sample.
TEST(PacketFilter, DropsQuestionsForFragmentsThatNoSampleHas) {
  for (const bool little : {true, false}) {
    const auto asked = [little](std::uint32_t first, std::uint32_t bits) {
      return Alone(FromPeer(little).NackFrag(test::kUserWriter, 1, first, bits));
    };
    EXPECT_EQ(asked(1, 1), PacketDrop::kNone);
    EXPECT_EQ(asked(100, 256), PacketDrop::kNone);
    EXPECT_EQ(asked(0, 0), PacketDrop::kMalformed);
    EXPECT_EQ(asked(0, 1), PacketDrop::kMalformed);
    EXPECT_EQ(asked(0, 32), PacketDrop::kMalformed);
    EXPECT_EQ(asked(0xffff'ffff, 2), PacketDrop::kMalformed) << "the second one is 0";
  }
}

// Fast DDS reads a signed number: beyond 2^15 it looks for the payload in front of the packet.
TEST(PacketFilter, DropsDataWhosePayloadTheLibraryWouldLookForElsewhere) {
  const auto drop_of = [](std::uint8_t high_of_octets_to_qos) {
    PacketBytes packet = FromPeer().Data(test::kUserWriter, 1, PacketBytes(50'000)).Bytes();
    packet[27] = high_of_octets_to_qos;
    return Alone(packet);
  };
  EXPECT_EQ(drop_of(0x7f), PacketDrop::kNone);
  EXPECT_EQ(drop_of(0x80), PacketDrop::kListTooLong);
}

TEST(PacketFilter, DropsFragmentsThatNoSenderCutsSoSmall) {
  const auto of = [](std::uint16_t bytes, std::uint32_t sample) {
    return Alone(FromPeer().DataFrag(test::kUserWriter, 1, 1, 1, bytes, sample, bytes));
  };
  EXPECT_EQ(of(3, 1200), PacketDrop::kMalformed);
  EXPECT_EQ(of(511, 1600), PacketDrop::kMalformed);
  EXPECT_EQ(of(512, 1600), PacketDrop::kNone);
}

// Regression: such samples never came.
TEST(PacketFilter, HandsOnALastFragmentOfASingleByte) {
  for (std::uint32_t last = 1; last <= 4; ++last) {
    for (std::uint32_t first = 1; first <= 3; ++first) {
      const std::size_t bytes = first == 3 ? last : 1000;
      EXPECT_EQ(
          Alone(FromPeer().DataFrag(test::kUserWriter, 1, first, 1, 1000, 2000 + last, bytes)),
          PacketDrop::kNone);
    }
  }
}

// Readers keep such samples without asking their filters.
TEST(PacketFilter, DropsSamplesMarkedAsThoseThatPassReadersFilters) {
  const auto with_qos = [](std::uint16_t fields, std::uint8_t id) {
    PacketBytes body(fields);
    body[2] = static_cast<std::uint8_t>(fields - 4);  // octets to the inline QoS
    body[16] = 1;                                     // the number's low half
    body.insert(body.end(), {id, 0, 0, 0, 1, 0, 0, 0});
    body.resize(body.size() + 4);
    return body;
  };
  EXPECT_EQ(Alone(FromPeer().Add(0x15, 0x06, with_qos(20, 0x55))), PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().Add(0x15, 0x06, with_qos(20, 0x56))), PacketDrop::kNone);
  const auto fragment = [&](std::uint8_t id) {
    PacketBytes body = with_qos(32, id);
    body[20] = body[24] = 1;  // the first one, of one
    body[27] = 4;             // of 1024 bytes, as the sample
    body[29] = 4;
    body.resize(32 + 8 + 1024);
    return Alone(FromPeer().Add(0x16, 0x02, body));
  };
  EXPECT_EQ(fragment(0x55), PacketDrop::kMalformed);
  EXPECT_EQ(fragment(0x56), PacketDrop::kNone);
}

// Issue 25: +3.9 GB, never freed.
TEST(PacketFilter, DropsFragmentsOfWhatNoTypeIsAsLargeAs) {
  EXPECT_EQ(Alone(FromPeer().DataFrag(test::kUserWriter, 1, 1, 1, 1000, 4'000'000'000, 1000)),
            PacketDrop::kSampleTooLarge);
  EXPECT_EQ(Alone(FromPeer().DataFrag(test::kUserWriter, 1, 1, 1, 1000, 65537, 1000)),
            PacketDrop::kSampleTooLarge);
}

// CVE-2025-62799, CVE-2026-22590: the library copies by what is stated.
TEST(PacketFilter, DropsFragmentsThatAreNotOfTheirSample) {
  const auto fragment = [](std::uint32_t first, std::uint16_t count, std::uint16_t size,
                           std::size_t payload) {
    return Alone(FromPeer().DataFrag(test::kUserWriter, 1, first, count, size, 2184, payload));
  };
  EXPECT_EQ(fragment(1, 2, 1000, 2000), PacketDrop::kNone);
  EXPECT_EQ(fragment(1, 3, 1000, 2184), PacketDrop::kNone);
  EXPECT_EQ(fragment(0, 1, 1000, 1000), PacketDrop::kMalformed);
  EXPECT_EQ(fragment(4, 1, 1000, 1000), PacketDrop::kMalformed);
  EXPECT_EQ(fragment(3, 2, 1000, 184), PacketDrop::kMalformed);
  EXPECT_EQ(fragment(1, 1, 1000, 996), PacketDrop::kMalformed);
  EXPECT_EQ(fragment(3, 1, 1000, 1000), PacketDrop::kMalformed);
  EXPECT_EQ(fragment(1, 1, 0, 0), PacketDrop::kMalformed);
}

// Readers keep fragments until their sample is complete: of a beacon that never is.
TEST(PacketFilter, DropsFragmentsOfSamplesThatAreSentWhole) {
  EXPECT_EQ(Alone(FromPeer().DataFrag(test::kUserWriter, 1, 1, 1, 100, 200, 100)),
            PacketDrop::kMalformed);
  EXPECT_EQ(Alone(FromPeer().DataFrag(test::kUserWriter, 1, 1, 1, 1000, kLeastFragmented, 1000)),
            PacketDrop::kNone);
}

TEST(PacketFilter, ReadsNothingBehindTheEndOfAPacket) {
  const PacketBytes whole =
      FromPeer().InfoTs().Announcement(kPeer, 1).Gap(test::kUserWriter, 1, 9, 40).Bytes();
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const PacketBytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    Alone(cut);  // under a sanitizer
  }
}

TEST(PacketFilter, OnLoopbackHearsLoopback) {
  PacketFilter filter({.loopback_only = true});
  const PacketBytes packet = FromPeer().InfoTs().Bytes();
  EXPECT_EQ(DropOf(packet, kStart, &filter), PacketDrop::kNone);
  EXPECT_EQ(filter.Check(packet, kElsewhere, kStart).drop, PacketDrop::kForeignSource);
  EXPECT_EQ(PacketFilter({}).Check(packet, kElsewhere, kStart).drop, PacketDrop::kNone);
}

// A writer at 20 Hz, as one receiver hears it.
class Received20Hz {
 public:
  PacketDrop Data(std::int64_t number) {
    return filter_.Check(FromPeer().Data(test::kUserWriter, number, kPayload).Bytes(), kHere, now_)
        .drop;
  }
  PacketDrop Heartbeat(std::int64_t first, std::int64_t last) {
    return filter_
        .Check(FromPeer().Heartbeat(test::kUserWriter, first, last, 1).Bytes(), kHere, now_)
        .drop;
  }
  // Of a late joiner: samples that are gone, and how far the writer is.
  PacketDrop GapAndHeartbeat(std::int64_t gone, std::int64_t first, std::int64_t last) {
    const RtpsPacket packet = FromPeer()
                                  .Gap(test::kUserWriter, gone, gone + 1, 0)
                                  .Heartbeat(test::kUserWriter, first, last, 1);
    return filter_.Check(packet.Bytes(), kHere, now_).drop;
  }
  void Wait(Nanoseconds time) { now_ += time; }
  // The writer is no longer new, and has come to `last`.
  void Settle(std::int64_t last) {
    for (std::int64_t number = last - 120; number < last;) {
      Wait(milliseconds(50));
      ASSERT_EQ(Data(++number), PacketDrop::kNone);
    }
  }

 private:
  PacketFilter filter_{{}};
  SteadyTime now_ = kStart;
};

// Issue 25: one copy of a scan with a number 2^40 ahead, and the vehicle never drives on.
TEST(PacketFilter, DropsNumbersThatTheWritersRateDoesNotAllow) {
  Received20Hz receiver;
  receiver.Settle(200);
  receiver.Wait(milliseconds(50));
  EXPECT_EQ(receiver.Data(201 + (std::int64_t{1} << 40U)), PacketDrop::kSequenceJump);
  EXPECT_EQ(receiver.Data(200 + kSlack + 20), PacketDrop::kSequenceJump);
  EXPECT_EQ(receiver.Heartbeat(kFar, kFar), PacketDrop::kSequenceJump);
  EXPECT_EQ(receiver.Data(201), PacketDrop::kNone) << "and the writer is still heard";
}

TEST(PacketFilter, HandsOnWhatComesAgainOrAfterALoss) {
  Received20Hz receiver;
  receiver.Settle(200);
  EXPECT_EQ(receiver.Data(200), PacketDrop::kNone);
  EXPECT_EQ(receiver.Data(3), PacketDrop::kNone) << "sent again, or a restart";
  EXPECT_EQ(receiver.Data(200 + kSlack), PacketDrop::kNone);
  receiver.Wait(seconds(60));
  EXPECT_EQ(receiver.Data(200 + kSlack + 60 * 20), PacketDrop::kNone) << "a blackout";
}

// Regression: a vehicle that joined a world after 22 restarts of another received no roster: the
// GAP before the heartbeat in the packet was taken for the writer's highest number.
TEST(PacketFilter, HandsOnTheSparseHistoryOfAnOldWriterToALateJoiner) {
  Received20Hz receiver;
  EXPECT_EQ(receiver.GapAndHeartbeat(4, 3, 5000), PacketDrop::kNone);
  EXPECT_EQ(receiver.Data(3), PacketDrop::kNone);
  EXPECT_EQ(receiver.Data(4000), PacketDrop::kNone);
  Received20Hz in_order;
  EXPECT_EQ(in_order.Data(3), PacketDrop::kNone);
  EXPECT_EQ(in_order.Data(4000), PacketDrop::kNone);
}

TEST(PacketFilter, GapsThatComeAgainDoNotHoldUpAWriterThatWasHeardLongAgo) {
  Received20Hz receiver;
  receiver.Settle(200);
  int dropped = 0;
  while (receiver.GapAndHeartbeat(200, 3, 700) != PacketDrop::kNone) {
    ASSERT_LT(++dropped, 20) << "500 samples were lost: two seconds";
    receiver.Wait(milliseconds(100));
  }
}

TEST(PacketFilter, HandsOnTheFirstThatIsHeardOfAnOldWriter) {
  EXPECT_EQ(Received20Hz().Data(WriterTable::kMostAtFirst), PacketDrop::kNone);
  EXPECT_EQ(Received20Hz().Heartbeat(WriterTable::kMostAtFirst - 9, WriterTable::kMostAtFirst),
            PacketDrop::kNone);
  EXPECT_EQ(Received20Hz().Heartbeat(kFar, kFar), PacketDrop::kSequenceJump);
}

TEST(PacketFilter, BelievesAJumpThatTheWriterKeepsTo) {
  Received20Hz receiver;
  receiver.Settle(200);
  int dropped = 0;
  for (std::int64_t number = 900'000; receiver.Data(number) != PacketDrop::kNone; ++number) {
    ASSERT_LT(++dropped, 20);
    receiver.Wait(milliseconds(50));
  }
  EXPECT_GE(dropped, 10) << "half a second";
}

TEST(PacketFilter, BelievesNoJumpWhileTheWriterIsHeardOnItsFormerLine) {
  Received20Hz receiver;
  receiver.Settle(200);
  for (std::int64_t i = 1; i <= 100; ++i) {
    EXPECT_EQ(receiver.Data(200 + i), PacketDrop::kNone);
    receiver.Wait(milliseconds(25));
    EXPECT_EQ(receiver.Data(900'000 + i), PacketDrop::kSequenceJump);
    receiver.Wait(milliseconds(25));
  }
}

// The world writes every body's pose, of a large fleet in one burst that overflows a socket.
TEST(PacketFilter, AllowsAFastWriterLargerSteps) {
  Received20Hz receiver;
  std::int64_t number = 1;
  for (int tick = 0; tick < 120; ++tick) {
    for (int body = 0; body < 200; ++body) ASSERT_EQ(receiver.Data(++number), PacketDrop::kNone);
    receiver.Wait(milliseconds(50));
  }
  EXPECT_EQ(receiver.Data(number + 600), PacketDrop::kNone);
  EXPECT_EQ(receiver.Data(number + 600 + 10'000), PacketDrop::kSequenceJump);
}

// The library ignores every HEARTBEAT and ACKNACK whose count is not above the highest: after one
// forged count those of the true sender would never be accepted again.
TEST(PacketFilter, DropsCountsThatJump) {
  constexpr std::uint32_t kHighest = 0xffff'ffff;
  const auto heartbeat = [](std::uint32_t count) {
    return FromPeer().Heartbeat(test::kUserWriter, 1, 1, count).Bytes();
  };
  const auto acknack = [](std::uint32_t count) {
    return FromPeer().AckNack(test::kUserWriter, 9, 40, 2, count).Bytes();
  };
  for (const auto& make : {std::function<PacketBytes(std::uint32_t)>(heartbeat),
                           std::function<PacketBytes(std::uint32_t)>(acknack)}) {
    PacketFilter filter({});
    SteadyTime now = kStart;
    EXPECT_EQ(DropOf(make(kHighest), now, &filter), PacketDrop::kSequenceJump);
    for (std::uint32_t count = 1; count < 100; ++count) {
      EXPECT_EQ(DropOf(make(count), now, &filter), PacketDrop::kNone) << count;
      EXPECT_EQ(DropOf(make(kHighest), now, &filter), PacketDrop::kSequenceJump);
      now += milliseconds(200);
    }
    EXPECT_EQ(DropOf(make(7), now, &filter), PacketDrop::kNone) << "a new reader";
    now += seconds(60);
    EXPECT_EQ(DropOf(make(400), now, &filter), PacketDrop::kNone) << "sent to others";
  }
}

TEST(PacketFilter, KeepsTheCountsOfReadersOfOneParticipantApart) {
  PacketFilter filter({});
  SteadyTime now = kStart;
  for (std::uint32_t i = 1; i <= 60; ++i) {
    for (const std::uint32_t reader : {0x000003c7U, 0x000004c7U}) {
      const std::uint32_t count = reader == 0x000003c7U ? i : 100'000 + i;
      const RtpsPacket packet = FromPeer().AckNack(test::kUserWriter, 9, 40, 2, count, reader);
      EXPECT_EQ(DropOf(packet.Bytes(), now, &filter), PacketDrop::kNone);
    }
    now += milliseconds(100);
  }
  const RtpsPacket ahead = FromPeer().AckNack(test::kUserWriter, 9, 40, 2, 1000, 0x000003c7);
  EXPECT_EQ(DropOf(ahead.Bytes(), now, &filter), PacketDrop::kSequenceJump);
}

test::PrefixBytes Stranger(std::uint32_t number) {
  return {9, 9, static_cast<std::uint8_t>(number >> 8U), static_cast<std::uint8_t>(number), 1};
}

// Issue 25: 5 000 forged announcements, +25 MB in each process.
TEST(PacketFilter, LetsStrangersInNoFasterThanAFleetGrows) {
  PacketFilter filter({.fleet_size = 2});
  SteadyTime now = kStart;
  const auto announce = [&](const test::PrefixBytes& from) {
    return DropOf(RtpsPacket(from).Announcement(from, 1).Bytes(), now, &filter);
  };
  EXPECT_EQ(announce(kPeer), PacketDrop::kNone);
  int let_in = 0;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    now += milliseconds(1);
    const PacketDrop drop = announce(Stranger(i));
    let_in += drop == PacketDrop::kNone ? 1 : 0;
    EXPECT_TRUE(drop == PacketDrop::kNone || drop == PacketDrop::kTooManyStrangers);
    EXPECT_TRUE(i % 100 != 0 || announce(kPeer) == PacketDrop::kNone)
        << "those that are in stay in";
  }
  EXPECT_LE(let_in, 256 + 2 * 2 + 5 * 4 + 1);
  EXPECT_GE(let_in, 256);
  now += seconds(1);
  EXPECT_EQ(announce(Stranger(6000)), PacketDrop::kNone) << "and afterwards it may grow again";
}

TEST(PacketFilter, NamesParticipantsByWhatTheyAnnounceNotByWhoSendsIt) {
  PacketFilter filter({.fleet_size = 0, .strangers = 64});
  int let_in = 0;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const PacketBytes packet = RtpsPacket(kPeer).Announcement(Stranger(i), i + 1).Bytes();
    let_in += DropOf(packet, kStart, &filter) == PacketDrop::kNone ? 1 : 0;
  }
  EXPECT_EQ(let_in, 64 - 1) << "the one that sends them is one too";
}

// Of each that announced a known participant, or none at all, the library kept a record for as long
// as it ran.
TEST(PacketFilter, LetsNoOtherSpeakForAParticipantThatIsIn) {
  for (const bool names_peer : {true, false}) {
    PacketFilter filter({.fleet_size = 0, .strangers = 64});
    EXPECT_EQ(DropOf(FromPeer().Announcement(kPeer, 1).Bytes(), kStart, &filter),
              PacketDrop::kNone);
    int let_in = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      RtpsPacket packet(Stranger(i));
      const PacketBytes empty_list = {0, 3, 0, 0, 1, 0, 0, 0};
      names_peer ? packet.Announcement(kPeer, 1) : packet.Data(test::kAnnouncer, 1, empty_list);
      let_in += DropOf(packet.Bytes(), kStart, &filter) == PacketDrop::kNone ? 1 : 0;
    }
    EXPECT_EQ(let_in, names_peer ? 64 - 1 : 0);
    EXPECT_EQ(DropOf(FromPeer().Announcement(kPeer, 2).Bytes(), kStart, &filter),
              PacketDrop::kNone);
  }
}

TEST(PacketFilter, LetsADiscoveryServerSpeakForOthers) {
  PacketFilter filter({.fleet_size = 2, .strangers = 64});
  for (std::uint32_t i = 0; i < 60; ++i) {
    EXPECT_EQ(DropOf(FromPeer().Announcement(Stranger(i), i + 1).Bytes(), kStart, &filter),
              PacketDrop::kNone);
  }
}

}  // namespace
}  // namespace giveway::link
