// Which parameter lists of discovery the packet filter passes: a list is intact if it ends where
// its payload does, and contains all that it counts.
#include "services/link/packet_filter/discovery_list.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "services/link/packet_filter/packet_filter.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using test::PacketBytes;
using test::RtpsPacket;

constexpr test::PrefixBytes kAnnounced = {1, 15, 7};
constexpr std::uint32_t kPublications = 0x000003c2;
constexpr std::uint32_t kSubscriptions = 0x000004c2;
constexpr std::uint32_t kDiscoveryWriters[] = {test::kAnnouncer, kPublications, kSubscriptions};
constexpr std::uint32_t kDiscoveryReaders[] = {0x000100c7, 0x000003c7, 0x000004c7};
constexpr std::uint16_t kNames[] = {0x05, 0x07, 0x62};
constexpr std::uint16_t kData[] = {0x2c, 0x2d, 0x2e};
constexpr std::uint16_t kPartitions = 0x29;
constexpr std::uint16_t kProperties = 0x59;
constexpr std::uint16_t kRepresentations = 0x73;
constexpr std::uint16_t kDataSharing = 0x8006;
constexpr std::uint16_t kTokens[] = {0x1001, 0x1002};

// A list in either byte order, or a value in one.
class List {
 public:
  explicit List(bool little = true) : little_(little) {}
  List& U16(std::uint16_t number) {
    const auto low = static_cast<std::uint8_t>(number);
    const auto high = static_cast<std::uint8_t>(number >> 8U);
    bytes_.insert(bytes_.end(), {little_ ? low : high, little_ ? high : low});
    return *this;
  }
  List& U32(std::uint32_t number) {
    const auto low = static_cast<std::uint16_t>(number);
    const auto high = static_cast<std::uint16_t>(number >> 16U);
    return little_ ? U16(low).U16(high) : U16(high).U16(low);
  }
  // Padded with zeros.
  List& Octets(PacketBytes octets) {
    octets.resize((octets.size() + 3) / 4 * 4);
    bytes_.insert(bytes_.end(), octets.begin(), octets.end());
    return *this;
  }
  List& Text(std::uint32_t stated = 4) { return U32(stated).Octets({'a', 'b', 'c', 0}); }
  List& Parameter(std::uint16_t id, const PacketBytes& value) {
    return U16(id).U16(static_cast<std::uint16_t>(value.size())).Octets(value);
  }
  List& End() { return Parameter(1, {}); }

  operator PacketBytes() const { return bytes_; }  // NOLINT: values are written as lists

 private:
  PacketBytes bytes_;
  bool little_;
};

PacketVerdict VerdictOn(const RtpsPacket& packet, bool secured = false) {
  PacketFilter filter({.secured = secured});
  return filter.Check(packet.Bytes(), 0x7f000001, std::chrono::seconds(1));
}

PacketDrop Judged(const RtpsPacket& packet, bool secured = false) {
  return VerdictOn(packet, secured).drop;
}

// With the encapsulation that the order has.
PacketBytes Payload(const PacketBytes& list, bool little = true) {
  PacketBytes payload = {0, static_cast<std::uint8_t>(little ? 3 : 2), 0, 0};
  payload.insert(payload.end(), list.begin(), list.end());
  return payload;
}

PacketDrop DropOfList(const PacketBytes& list, bool little = true, bool secured = false,
                      std::uint32_t writer = kPublications) {
  // The submessage's own order is the other one.
  return Judged(
      RtpsPacket(kAnnounced, test::kEProsima, !little).Data(writer, 1, Payload(list, little)),
      secured);
}

PacketDrop DropOf(std::uint16_t id, const PacketBytes& value, bool little = true,
                  bool secured = false) {
  return DropOfList(List(little).Parameter(id, value).End(), little, secured);
}

PacketBytes GuidOf(const test::PrefixBytes& prefix, std::uint8_t last_of_entity = 0xc1) {
  PacketBytes guid(prefix.begin(), prefix.end());
  guid.insert(guid.end(), {0, 0, 1, last_of_entity});
  return guid;
}

constexpr auto kTooLong = PacketDrop::kListTooLong;
constexpr auto kSound = PacketDrop::kNone;

TEST(DiscoveryList, HandsOnWhatAnEndpointSaysOfItself) {
  for (const bool little : {true, false}) {
    List list(little);
    list.Parameter(0x50, GuidOf(kAnnounced));  // of a participant
    for (const std::uint16_t id : kNames) list.Parameter(id, List(little).Text());
    for (const std::uint16_t id : kData) list.Parameter(id, List(little).U32(3).Octets({1, 2, 3}));
    list.Parameter(kData[0], List(little).U32(0));
    list.Parameter(kPartitions, List(little).U32(0));
    list.Parameter(kPartitions, List(little).U32(2).Text().Text());
    list.Parameter(kProperties, List(little).U32(1).Text().Text());
    list.Parameter(kRepresentations, List(little).U32(3).Octets({0, 0, 0, 1, 0, 2}));
    list.Parameter(kDataSharing, List(little).U32(1).Octets(PacketBytes(8)));
    list.Parameter(0x75, PacketBytes(50, 0xff)).End();
    for (const std::uint32_t writer : kDiscoveryWriters) {
      EXPECT_EQ(DropOfList(list, little, false, writer), kSound);
    }
  }
}

TEST(DiscoveryList, IsSoundInAnAnnouncementOfTheLibrary) {
  for (const bool little : {true, false}) {
    EXPECT_EQ(Judged(RtpsPacket(kAnnounced, test::kEProsima, little).Announcement(kAnnounced, 1)),
              kSound);
  }
}

TEST(DiscoveryList, EndsWithinItsPayload) {
  for (const std::uint32_t writer : kDiscoveryWriters) {
    const PacketBytes endless = List().Parameter(kNames[0], List().Text());
    EXPECT_EQ(DropOfList(endless, true, false, writer), kTooLong);
    EXPECT_EQ(DropOfList({}, true, false, writer), kTooLong);
    PacketBytes beyond = List().Parameter(0x75, PacketBytes(8)).End();
    beyond[2] = 16;
    EXPECT_EQ(DropOfList(beyond, true, false, writer), kTooLong);
  }
}

TEST(DiscoveryList, IsReadForTheReaderThatItNamesToo) {
  for (const std::uint32_t reader : kDiscoveryReaders) {
    EXPECT_EQ(Judged(RtpsPacket(kAnnounced).Data(test::kUserWriter, 1, Payload({}), reader)),
              kTooLong);
  }
  EXPECT_EQ(Judged(RtpsPacket(kAnnounced).Data(test::kUserWriter, 1, Payload({}))), kSound);
}

TEST(DiscoveryList, IsReadWhereItIsTheKeyOfWhatEnds) {
  const RtpsPacket sound = RtpsPacket(kAnnounced).Data(kPublications, 1, Payload(List().End()));
  const RtpsPacket endless = RtpsPacket(kAnnounced).Data(kPublications, 1, Payload({}));
  for (const RtpsPacket& packet : {sound, endless}) {
    PacketBytes bytes = packet.Bytes();
    bytes[21] = 0x09;  // flags: little-endian, with a key
    EXPECT_EQ(PacketFilter({}).Check(bytes, 0x7f000001, std::chrono::seconds(1)).drop,
              Judged(packet));
  }
}

TEST(DiscoveryList, IsNothingInAnEncapsulationThatTheLibraryIgnores) {
  for (const std::uint8_t encapsulation : std::to_array<std::uint8_t>({0, 1, 7, 10})) {
    const PacketBytes payload = {0, encapsulation, 0, 0};
    EXPECT_EQ(Judged(RtpsPacket(kAnnounced).Data(kPublications, 1, payload)), kSound);
  }
}

// CVE-2024-30258, CVE-2024-30259, CVE-2025-62599 to 62602, CVE-2025-64098: one packet took 3.9 GB
// and ended the process, with security off.
TEST(DiscoveryList, HasNoTokensWithoutSecurity) {
  for (const std::uint16_t id : kTokens) {
    const PacketBytes token = List().Text().U32(0).U32(0);
    EXPECT_EQ(DropOf(id, token), PacketDrop::kMalformed);
    EXPECT_EQ(DropOf(id, token, true, true), kSound) << "with security";
  }
}

TEST(DiscoveryList, HoldsAllOfATokenWithSecurity) {
  constexpr std::uint32_t kHuge = 0xfffffff0;
  for (const std::uint16_t id : kTokens) {
    const auto secured = [&](const List& token) { return DropOf(id, token, true, true); };
    EXPECT_EQ(secured(List().Text().U32(1).Text().Text().U32(1).Text().Text()), kSound);
    EXPECT_EQ(secured(List().Text().U32(0)), kTooLong);
    EXPECT_EQ(secured(List().Text(kHuge).U32(0).U32(0)), kTooLong);
    EXPECT_EQ(secured(List().Text().U32(kHuge).U32(0)), kTooLong);
    EXPECT_EQ(secured(List().Text().U32(1).Text(kHuge).Text().U32(0)), kTooLong);
    EXPECT_EQ(secured(List().Text().U32(1).Text().Text(kHuge).U32(0)), kTooLong);
    EXPECT_EQ(secured(List().Text().U32(0).U32(60'000'000)), kTooLong);
    EXPECT_EQ(secured(List().Text().U32(0).U32(1).Text().Text(3'000'000'000)), kTooLong);
  }
}

TEST(DiscoveryList, HoldsNamesAndDataOfTheStatedLengths) {
  for (const auto& ids : {kNames, kData}) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const bool little : {true, false}) {
        EXPECT_EQ(DropOf(ids[i], List(little).Text(5), little), kTooLong) << ids[i];
        EXPECT_EQ(DropOf(ids[i], List(little).Text(0xffff'ffff), little), kTooLong) << ids[i];
        EXPECT_EQ(DropOf(ids[i], {}, little), kTooLong) << ids[i];
      }
    }
  }
}

// CVE-2026-49861: +0.8 GB for 400 million of them.
TEST(DiscoveryList, HoldsAsManyRepresentationsAndDomainsAsItStates) {
  EXPECT_EQ(DropOf(kRepresentations, List().U32(400'000'000).U16(0)), kTooLong);
  EXPECT_EQ(DropOf(kRepresentations, List().U32(3).U32(0)), kTooLong);
  EXPECT_EQ(DropOf(kRepresentations, List().U32(0x8000'0001).U32(0)), kTooLong);
  EXPECT_EQ(DropOf(kDataSharing, List().U32(2).Octets(PacketBytes(12))), kTooLong);
}

// CVE-2026-53590: a text beyond the list was read.
TEST(DiscoveryList, HoldsAsManyPropertiesAsItStates) {
  EXPECT_EQ(DropOf(kProperties, List().U32(0x7fff'ffff).Text().Text()), kTooLong);
  EXPECT_EQ(DropOf(kProperties, List().U32(1).Text()), kTooLong);
  EXPECT_EQ(DropOf(kProperties, List().U32(1).Text().Text(5)), kTooLong);
}

// CVE-2026-55063, GHSA-8g7x-c9fg-g6mh: read until the next NUL.
TEST(DiscoveryList, HoldsPartitionsWithTheirEnds) {
  EXPECT_EQ(DropOf(kPartitions, List().U32(2).Text()), kTooLong);
  EXPECT_EQ(DropOf(kPartitions, List().U32(1).Text(0x7fff'ff00)), kTooLong);
  EXPECT_EQ(DropOf(kPartitions, List().U32(1).Text(0xffff'ffff)), kTooLong);
  EXPECT_EQ(DropOf(kPartitions, List().U32(1).U32(0)), kTooLong) << "no NUL";
  EXPECT_EQ(DropOf(kPartitions, List().U32(1).Text(3)), kTooLong) << "no NUL";
}

// One of 64 kB had 8000 partitions, and each process kept 128 such permanently.
TEST(DiscoveryList, HoldsNoMorePartitionsThanAnEndpointHas) {
  const auto of = [](std::uint32_t partitions) {
    List list;
    list.U32(partitions);
    for (std::uint32_t i = 0; i < partitions; ++i) list.Text();
    return DropOf(kPartitions, list);
  };
  EXPECT_EQ(of(64), kSound);
  EXPECT_EQ(of(65), kTooLong);
}

TEST(DiscoveryList, IsNoLongerThanWhatAnEndpointSaysOfItself) {
  const auto of = [](std::uint16_t id, std::uint32_t bytes) {
    return DropOf(id, List().U32(bytes).Octets(PacketBytes(bytes)));
  };
  EXPECT_EQ(of(kData[0], 8000), kSound) << "of Cyclone DDS with long user data";
  EXPECT_EQ(of(kData[0], 8192), kTooLong);
  EXPECT_EQ(of(0x75, 16'000), kSound) << "a type";
  EXPECT_EQ(of(0x75, 17'000), kTooLong);
  List many;
  for (int i = 0; i < 1000; ++i) many.Parameter(kNames[0], List().Text());
  EXPECT_EQ(DropOfList(many.End()), kTooLong);
}

// An announcement of kAnnounced with more parameters at its end.
PacketDrop DropWithMore(const List& more) {
  const PacketBytes parameters = more;
  return Judged(RtpsPacket(kAnnounced).Announcement(kAnnounced, 1, 20, parameters));
}

// A stranger that adds its name behind that of a known participant was let in without being
// counted: the library takes the last.
TEST(DiscoveryList, NamesAParticipantOnce) {
  constexpr test::PrefixBytes kStranger = {9, 9, 9};
  EXPECT_EQ(DropWithMore(List().Parameter(0x50, GuidOf(kStranger))), PacketDrop::kMalformed);
  EXPECT_EQ(DropWithMore(List().Parameter(0x70, GuidOf(kStranger))), PacketDrop::kMalformed)
      << "of the hash of a key the library makes the name";
  EXPECT_EQ(DropWithMore(List().Parameter(0x02, PacketBytes(8))), PacketDrop::kMalformed)
      << "a second lease";
  EXPECT_EQ(DropWithMore(List().Parameter(0x8050, GuidOf(kStranger))), kSound);
}

TEST(DiscoveryList, NamesAParticipantByAWholeGuid) {
  const auto drop_of = [](std::uint16_t id, const PacketBytes& value) {
    return DropOfList(List().Parameter(id, value).End(), true, false, test::kAnnouncer);
  };
  PacketBytes guid = GuidOf(kAnnounced);
  EXPECT_EQ(drop_of(0x50, guid), kSound);
  EXPECT_EQ(drop_of(0x50, GuidOf(kAnnounced, 0xc2)), PacketDrop::kMalformed)
      << "the library knows them by their entity ids too";
  EXPECT_EQ(drop_of(0x50, {}), PacketDrop::kMalformed);
  guid.resize(12);
  EXPECT_EQ(drop_of(0x50, guid), PacketDrop::kMalformed);
  guid.resize(20);
  EXPECT_EQ(drop_of(0x50, guid), PacketDrop::kMalformed);
  EXPECT_EQ(drop_of(0x02, PacketBytes(4)), PacketDrop::kMalformed) << "a lease";
}

TEST(DiscoveryList, NamesEndpointsByTheHashOfTheirKeyToo) {
  const PacketBytes list =
      List().Parameter(0x70, GuidOf(kAnnounced)).Parameter(0x5a, GuidOf(kAnnounced)).End();
  EXPECT_EQ(DropOfList(list), kSound);
}

// A list with a second name was counted as one of the first: the library takes the last.
TEST(DiscoveryList, NamesOneEndpoint) {
  const auto drop_of = [](std::uint16_t id, const PacketBytes& value) {
    return DropOfList(List().Parameter(0x5a, GuidOf(kAnnounced)).Parameter(id, value).End());
  };
  for (const std::uint16_t id : {std::uint16_t{0x5a}, std::uint16_t{0x70}}) {
    EXPECT_EQ(drop_of(id, GuidOf(kAnnounced)), kSound);
    EXPECT_EQ(drop_of(id, GuidOf(kAnnounced, 0xc2)), PacketDrop::kMalformed);
    EXPECT_EQ(drop_of(id, PacketBytes(12)), PacketDrop::kMalformed);
    EXPECT_EQ(drop_of(id, {}), PacketDrop::kMalformed);
  }
}

TEST(DiscoveryList, ComesInOnePiece) {
  for (const std::uint32_t writer : kDiscoveryWriters) {
    EXPECT_EQ(Judged(RtpsPacket(kAnnounced).DataFrag(writer, 1, 1, 1, 1000, 2000, 1000)),
              PacketDrop::kFragmentedAnnouncement);
  }
  for (const std::uint32_t reader : kDiscoveryReaders) {
    EXPECT_EQ(
        Judged(
            RtpsPacket(kAnnounced).DataFrag(test::kUserWriter, 1, 1, 1, 1000, 2000, 1000, reader)),
        PacketDrop::kFragmentedAnnouncement);
  }
}

// The library decodes type information as it comes, and checks no length in it.
TEST(DiscoveryList, HidesWhatItSaysOfTypes) {
  for (const bool little : {true, false}) {
    const auto payload_with = [little](const std::array<std::uint16_t, 3>& ids) {
      List list(little);
      list.Parameter(kNames[0], List(little).Text());
      for (const std::uint16_t id : ids) list.Parameter(id, PacketBytes(10, 0xff));
      return Payload(list.Parameter(kPartitions, List(little).U32(1).Text()).End(), little);
    };
    const PacketBytes types = payload_with({0x69, 0x72, 0x75});
    // Samples of a user's writer are no parameter lists.
    const auto packet_of = [&](const PacketBytes& announced) {
      return RtpsPacket(kAnnounced, test::kEProsima, !little)
          .Data(test::kUserWriter, 1, types)
          .Data(kPublications, 1, announced)
          .Data(kSubscriptions, 1, announced)
          .Bytes();
    };
    PacketBytes packet = packet_of(types);
    HideTypes(packet);
    EXPECT_EQ(packet, packet_of(payload_with({0, 0, 0})));
  }
}

TEST(DiscoveryList, IsSaidToBeThereWhereItIs) {
  const auto announces = [](const RtpsPacket& packet) {
    const PacketVerdict verdict = VerdictOn(packet);
    EXPECT_EQ(verdict.drop, kSound);
    return verdict.announces;
  };
  const PacketBytes payload = Payload(List().End());
  EXPECT_FALSE(announces(RtpsPacket(kAnnounced).Data(test::kUserWriter, 1, payload)));
  EXPECT_TRUE(announces(RtpsPacket(kAnnounced).Data(kPublications, 1, payload)));
  EXPECT_TRUE(announces(RtpsPacket(kAnnounced).Data(kPublications, 2, payload).Statistics()));
}

}  // namespace
}  // namespace giveway::link
