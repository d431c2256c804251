// Samples that come in fragments, and what is made of them.
#include "services/link/packet_filter/fragment_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "services/link/packet_filter/packet_filter.h"
#include "services/link/packet_filter/submessage_check.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using test::PacketBytes;
using test::RtpsPacket;

constexpr test::PrefixBytes kCutting = {1, 15, 6};
constexpr test::PrefixBytes kCutFor = {1, 15, 2};
constexpr std::uint32_t kLargest = 120'000;

std::uint8_t ByteAt(std::size_t place) {
  return static_cast<std::uint8_t>(place * 7 + place / 251);
}

// Fragments of samples whose bytes are known, put together.
class Fragments : public ::testing::Test {
 protected:
  explicit Fragments(std::size_t most_bytes = 1'000'000) : store_(most_bytes) {}

  static RtpsPacket From(bool little = true) {
    return RtpsPacket(kCutting, test::kEProsima, little);
  }
  // With the sample's bytes in their places behind what the writer of packets leaves 0.
  static PacketBytes Filled(const RtpsPacket& packet, std::size_t first_byte, std::size_t bytes) {
    PacketBytes filled = packet.Bytes();
    const std::size_t at = filled.size() - bytes;
    for (std::size_t i = 0; i < bytes; ++i) filled[at + i] = ByteAt(first_byte + i);
    return filled;
  }
  static PacketBytes Piece(std::int64_t number, std::uint32_t sample, std::uint16_t piece,
                           std::uint32_t first, std::uint16_t count = 1, bool little = true,
                           std::uint32_t writer = test::kUserWriter) {
    const std::size_t before = (first - std::size_t{1}) * piece;
    const std::size_t bytes = std::min<std::size_t>(std::size_t{count} * piece, sample - before);
    return Filled(
        From(little).InfoTs().DataFrag(writer, number, first, count, piece, sample, bytes), before,
        bytes);
  }
  std::vector<OwnedPacket> Take(const PacketBytes& packet) {
    EXPECT_EQ(
        PacketFilter({.largest_sample = kLargest}).Check(packet, 0x7f000001, SteadyTime{1}).drop,
        PacketDrop::kNone);
    return store_.Take(packet, participants_);
  }
  // Of one sample all but one fragment.
  void TakeAllBut(std::uint32_t missing, std::int64_t number, std::uint32_t sample,
                  std::uint16_t piece) {
    for (std::uint32_t first = 1; (first - 1) * piece < sample; ++first) {
      if (first != missing) {
        EXPECT_TRUE(Take(Piece(number, sample, piece, first)).empty());
      }
    }
  }
  // Whether it is one sound DATA of the whole sample, from that writer and number.
  static void ExpectWhole(const std::vector<OwnedPacket>& whole, std::int64_t number,
                          std::uint32_t sample) {
    ASSERT_EQ(whole.size(), 1U);
    EXPECT_TRUE(std::ranges::equal(SenderOf(whole[0]), kCutting));
    SubmessageWalk walk(whole[0]);
    Submessage part;
    ASSERT_TRUE(walk.Next(&part));
    while (part.kind != SubmessageKind::kData) ASSERT_TRUE(walk.Next(&part));
    EXPECT_TRUE(walk.IsAtEnd());
    EXPECT_EQ(CheckSubmessage(part, kLargest), PacketDrop::kNone);
    EXPECT_EQ(part.SequenceNumber(kNumberInData), number);
    EXPECT_TRUE(part.Has(kWithData));
    const Bytes payload = part.body.subspan(PayloadOfData(part));
    ASSERT_EQ(payload.size(), sample);
    for (std::size_t i = 0; i < sample; ++i) ASSERT_EQ(payload[i], ByteAt(i)) << i;
  }

  FragmentStore store_;
  ParticipantTable participants_{64, 2};
};

TEST_F(Fragments, AreHandedOnAsOneSampleWhenAllHaveCome) {
  for (const bool little : {true, false}) {
    EXPECT_TRUE(Take(Piece(1, kLargest, 60'000, 1, 1, little)).empty());
    ExpectWhole(Take(Piece(1, kLargest, 60'000, 2, 1, little)), 1, kLargest);
    EXPECT_EQ(store_.KeptBytes(), 0U);
  }
}

TEST_F(Fragments, InAnyOrderTwiceAndSeveralInOnePacketMakeOneSample) {
  TakeAllBut(2, 5, 10'001, 1344);
  EXPECT_TRUE(Take(Piece(5, 10'001, 1344, 3, 4)).empty()) << "which had come";
  ExpectWhole(Take(Piece(5, 10'001, 1344, 1, 3)), 5, 10'001);
}

TEST_F(Fragments, AreOfWhatTheyWereSentAs) {
  const auto of = [](std::uint32_t first, const test::PrefixBytes& to, std::uint32_t reader) {
    const RtpsPacket packet = From().InfoDst(to).InfoTs().DataFrag(test::kUserWriter, 3, first, 1,
                                                                   1000, 2000, 1000, reader);
    return Filled(packet, (first - std::size_t{1}) * 1000, 1000);
  };
  EXPECT_TRUE(Take(of(1, kCutFor, 4)).empty());
  std::vector<OwnedPacket> whole = Take(of(2, kCutFor, 4));
  ExpectWhole(whole, 3, 2000);
  const RtpsPacket expected = From().InfoDst(kCutFor).InfoTs().Data(test::kUserWriter, 3, {}, 4);
  const auto head = static_cast<std::ptrdiff_t>(expected.Bytes().size());
  whole[0][20 + 16 + 12 + 2] = 20;  // the length, which is left open
  EXPECT_TRUE(std::equal(whole[0].begin(), whole[0].begin() + head, expected.Bytes().begin()));
  EXPECT_TRUE(Take(of(1, kCutFor, 4)).empty());
  whole = Take(of(2, {}, 5));
  ExpectWhole(whole, 3, 2000);
  EXPECT_EQ(whole[0].size(), 20U + 12 + 4 + 20 + 2000) << "for all, as it went to more than one";
}

// The library copied 65 536 bytes from a payload of 1024: it went by the sample's first fragment.
TEST_F(Fragments, ThatContradictEachOtherAreOfDifferentSamples) {
  EXPECT_TRUE(Take(Piece(1, 65'536, 1024, 1)).empty());
  ExpectWhole(Take(Piece(1, 32'768, 512, 1, 64)), 1, 32'768);
  ExpectWhole(Take(Piece(1, 65'536, 1024, 2, 63)), 1, 65'536);
  EXPECT_TRUE(Take(Piece(2, 40'960, 1024, 1)).empty());
  ExpectWhole(Take(Piece(2, 40'960, 2048, 1, 20)), 2, 40'960);
}

// 44 bytes each reserved the memory of a sample in the library: 170 MB a datagram, never freed.
TEST_F(Fragments, OfSamplesWithoutEndTakeBoundedMemory) {
  for (std::int64_t number = 1; number <= 5000; ++number) {
    EXPECT_TRUE(store_.Take(Piece(number, kLargest, 1024, 1), participants_).empty());
    ASSERT_LE(store_.KeptBytes(), 1'000'000U);
  }
  TakeAllBut(1, 6000, kLargest, 30'000);
  for (std::int64_t number = 1; number <= 100; ++number) {
    store_.Take(Piece(number, kLargest, 1024, 1), participants_);
  }
  ExpectWhole(Take(Piece(6000, kLargest, 30'000, 1)), 6000, kLargest);
}

// Regression: five datagrams of forged fragments, and none of the fleet's own samples became whole.
TEST_F(Fragments, OfParticipantsThatAreNotKnownGiveWayFirst) {
  ASSERT_TRUE(participants_.MayJoin(kCutting, SteadyTime{1}));
  TakeAllBut(1, 6000, kLargest, 30'000);
  for (std::int64_t number = 1; number <= 5000; ++number) {
    RtpsPacket forged(kCutFor);
    forged.DataFrag(test::kUserWriter, number, 1, 1, 1024, kLargest, 1024);
    EXPECT_TRUE(store_.Take(forged.Bytes(), participants_).empty());
    ASSERT_LE(store_.KeptBytes(), 1'000'000U);
  }
  ExpectWhole(Take(Piece(6000, kLargest, 30'000, 1)), 6000, kLargest);
}

// Regression: it had those of the fragment that came last, which with Cyclone has none: samples had
// no source timestamp, and their keys no hash.
TEST_F(Fragments, HaveTheTimeAndTheInlineQosOfTheFirstOne) {
  const auto with_qos = [](std::uint32_t first, std::uint8_t value, bool has_qos, bool little) {
    RtpsPacket packet(kCutting, test::kCyclone, little);
    const auto word = [&](std::uint8_t low) {
      return little ? PacketBytes{low, 0} : PacketBytes{0, low};
    };
    PacketBytes time(8, value);
    if (has_qos) packet.Add(0x09, 0, time);
    PacketBytes frag = RtpsPacket(kCutting, test::kCyclone, little)
                           .DataFrag(test::kUserWriter, 3, first, 1, 1000, 2000, 1000)
                           .Bytes();
    frag.erase(frag.begin(), frag.begin() + 24);
    for (std::size_t i = 0; i < 1000; ++i)
      frag[32 + i] = ByteAt((first - std::size_t{1}) * 1000 + i);
    if (!has_qos) return packet.Add(0x16, 0, frag).Bytes();
    PacketBytes qos;
    for (const std::uint8_t half : {std::uint8_t{0x56}, std::uint8_t{4}}) {
      const PacketBytes bytes = word(half);
      qos.insert(qos.end(), bytes.begin(), bytes.end());
    }
    qos.insert(qos.end(), {value, value, value, value});
    for (const std::uint8_t half : {std::uint8_t{1}, std::uint8_t{0}}) {
      const PacketBytes bytes = word(half);
      qos.insert(qos.end(), bytes.begin(), bytes.end());
    }
    frag.insert(frag.begin() + 32, qos.begin(), qos.end());
    return packet.Add(0x16, kInlineQos, frag).Bytes();
  };
  const auto expect = [](const std::vector<OwnedPacket>& whole, std::uint8_t value) {
    ExpectWhole(whole, 3, 2000);
    PacketContext context(whole[0]);
    SubmessageWalk walk(whole[0]);
    Submessage part;
    while (walk.Next(&part) && part.kind != SubmessageKind::kData) context.Note(part);
    ASSERT_TRUE(context.time.has_value());
    EXPECT_EQ(context.time->body[0], value);
    const Bytes found = FindInlineParameter(part, 0x56);
    ASSERT_EQ(found.size(), 4U);
    EXPECT_EQ(found[0], value);
  };
  for (const bool little : {true, false}) {
    Take(with_qos(1, 7, true, little));
    expect(Take(with_qos(2, 0, false, !little)), 7);
    Take(with_qos(2, 0, false, !little));
    expect(Take(with_qos(1, 7, true, little)), 7);
    Take(with_qos(2, 9, true, !little));
    expect(Take(with_qos(1, 7, true, little)), 7);
    Take(with_qos(1, 7, true, little));
    expect(Take(with_qos(2, 9, true, !little)), 7);
    Take(with_qos(1, 0, false, !little));
    expect(Take(with_qos(2, 9, true, little)), 9);
    EXPECT_EQ(store_.KeptBytes(), 0U);
  }
}

// One fragment of a forged number ahead, then the sample of that number whole, or a GAP over it:
// the library ended the process by an assertion.
TEST_F(Fragments, AreHiddenFromTheLibrary) {
  const RtpsPacket packet = From()
                                .InfoDst(kCutFor)
                                .DataFrag(test::kUserWriter, 1, 1, 1, 1000, 2184, 1000)
                                .Heartbeat(test::kUserWriter, 1, 1, 1);
  EXPECT_EQ(WithoutFragments(packet.Bytes()),
            From().InfoDst(kCutFor).Heartbeat(test::kUserWriter, 1, 1, 1).Bytes());
  EXPECT_TRUE(WithoutFragments(Piece(1, 2184, 1000, 1)).empty());
  const PacketFilterOptions options{.largest_sample = kLargest};
  EXPECT_TRUE(PacketFilter(options).Check(packet.Bytes(), 0x7f000001, SteadyTime{1}).has_fragments);
  EXPECT_FALSE(PacketFilter(options)
                   .Check(From().InfoTs().Bytes(), 0x7f000001, SteadyTime{1})
                   .has_fragments);
}

}  // namespace
}  // namespace giveway::link
