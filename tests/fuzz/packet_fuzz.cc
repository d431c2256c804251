// Any bytes as packets to the filter: it reads nothing beyond them, says the same of the same bytes
// by themselves, hands on no more than there is, and what it hands on holds nothing that it says it
// drops.
//
// An input is a row of packets, each behind two bytes, little-endian, that say how long it is.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "services/link/packet_filter/discovery_list.h"
#include "services/link/packet_filter/discovery_order.h"
#include "services/link/packet_filter/packet_filter.h"
#include "services/link/packet_filter/submessage_check.h"
#include "services/types/check.h"
#include "tests/fuzz/target.h"
#include "tests/support/rtps_packet.h"

namespace giveway::fuzz {
namespace {

using link::Bytes;
using test::RtpsPacket;

constexpr std::uint32_t kSource = 0x7f000001;
constexpr std::uint32_t kLargestSample = 65536;
constexpr Nanoseconds kApart = std::chrono::milliseconds(7);

// Few writers are remembered: then they are forgotten often, and a filter is made in a microsecond.
constexpr std::size_t kWriters = 16;

const link::PacketFilterOptions kOptions{
    .largest_sample = kLargestSample, .writers = kWriters, .loopback_only = true};

// Every submessage of what is handed on is sound, and of a kind the library knows.
void CheckHandedOn(Bytes packet) {
  constexpr std::size_t kVendorAt = 6;
  const bool ours = packet[kVendorAt] == 1 && packet[kVendorAt + 1] == 0x0f;
  link::SubmessageWalk walk(packet);
  link::Submessage part;
  while (walk.Next(&part)) {
    const auto kind = static_cast<std::uint8_t>(part.kind);
    if (!ours && kind >= 0x80) continue;
    GIVEWAY_CHECK(kind < 0x80);
    GIVEWAY_CHECK(link::CheckSubmessage(part, kLargestSample) == PacketDrop::kNone);
    GIVEWAY_CHECK(!link::IsOfDiscovery(part) ||
                  link::CheckDiscovery(part, kOptions.secured) == PacketDrop::kNone);
  }
  GIVEWAY_CHECK(!walk.IsBroken());
}

std::vector<PacketDrop> JudgeAll(Bytes bytes) {
  link::PacketFilter filter(kOptions);
  std::vector<PacketDrop> drops;
  SteadyTime now = std::chrono::seconds(1);
  while (bytes.size() >= 2) {
    const std::size_t length = std::min<std::size_t>(bytes[0] + 256U * bytes[1], bytes.size() - 2);
    // A copy of the exact size: reading past its end is seen.
    const std::vector<std::uint8_t> packet(bytes.begin() + 2,
                                           bytes.begin() + 2 + static_cast<std::ptrdiff_t>(length));
    bytes = bytes.subspan(2 + length);
    const link::PacketVerdict verdict = filter.Check(packet, kSource, now += kApart);
    drops.push_back(verdict.drop);
    if (link::AcknowledgesDiscovery(packet)) filter.HearOwn(packet);
    if (verdict.drop != PacketDrop::kNone) continue;
    GIVEWAY_CHECK(verdict.bytes <= packet.size());
    std::vector<std::uint8_t> shortened = packet;
    shortened.resize(verdict.bytes);
    if (verdict.has_long_gaps) link::ShortenGaps(shortened);
    CheckHandedOn(shortened);
    std::vector<std::uint8_t> hidden = shortened;
    link::HideTypes(hidden);
    GIVEWAY_CHECK(verdict.announces || std::ranges::equal(hidden, shortened));
    CheckHandedOn(hidden);
  }
  return drops;
}

Input Row(const std::vector<test::PacketBytes>& packets) {
  Input input;
  for (const test::PacketBytes& packet : packets) {
    input += static_cast<char>(packet.size() & 0xffU);
    input += static_cast<char>(packet.size() >> 8U);
    input.append(packet.begin(), packet.end());
  }
  return input;
}

}  // namespace

std::vector<Input> Samples() {
  const test::PrefixBytes peer{1, 15, 7};
  const test::PacketBytes payload{0, 1, 0, 0, 1, 2, 3, 4};
  std::vector<Input> samples;
  for (const bool little : {true, false}) {
    const auto from_peer = [&] { return RtpsPacket(peer, test::kEProsima, little); };
    // A name, partitions, properties, representations, a token: each empty.
    const auto swapped = [&](std::uint8_t low, std::uint8_t high) {
      return little ? test::PacketBytes{low, high} : test::PacketBytes{high, low};
    };
    test::PacketBytes list;
    for (const std::uint8_t id : std::to_array<std::uint8_t>({0x05, 0x29, 0x59, 0x73, 0x01})) {
      for (const test::PacketBytes& half : {swapped(id, id == 1 ? 0x10 : 0), swapped(4, 0)}) {
        list.insert(list.end(), half.begin(), half.end());
      }
      list.resize(list.size() + 4);
    }
    samples.push_back(Row({from_peer().Announcement(peer, 1, 20, list).Bytes()}));
    samples.push_back(Row({from_peer()
                               .Gap(test::kUserWriter, 1, 150'000, 40)
                               .Gap(test::kUserWriter, 150'000, 150'001)
                               .Heartbeat(test::kUserWriter, 1, 150'002, 1)
                               .Bytes()}));
    samples.push_back(Row({from_peer().Announcement(peer, 1).Statistics().Bytes(),
                           from_peer().InfoTs().Data(test::kUserWriter, 1, payload).Bytes(),
                           from_peer().Heartbeat(test::kUserWriter, 1, 2, 1).Bytes()}));
    samples.push_back(
        Row({from_peer().InfoDst(peer).Gap(test::kUserWriter, 3, 5, 40).Bytes(),
             from_peer().DataFrag(test::kUserWriter, 6, 3, 1, 1000, 2184, 184).Bytes(),
             from_peer().AckNack(test::kUserWriter, 9, 256, 8).Statistics().Bytes()}));
    test::PacketBytes assertion{0, 3, 0, 0};
    assertion.insert(assertion.end(), peer.begin(), peer.end());
    assertion.insert(assertion.end(), {0, 0, 0, 1, 0, 0, 0, 0});
    samples.push_back(
        Row({from_peer().Announcement(peer, 1).Data(0x000200c2, 1, assertion).Bytes(),
             from_peer().WriterAnnouncement(peer, 0x102, 3).Gap(test::kPublications, 1, 2).Bytes(),
             from_peer().InfoDst(peer).AckNack(test::kPublications, 4, 0, 0).Bytes(),
             from_peer().DataFrag(test::kUserWriter, 6, 1, 3, 1000, 2184, 2184).Bytes(),
             from_peer().NackFrag(test::kUserWriter, 6, 1, 32).Bytes()}));
  }
  samples.push_back(Row({RtpsPacket(peer, test::kCyclone).Add(0x81, 0, payload).Bytes()}));
  return samples;
}

}  // namespace giveway::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const giveway::link::Bytes bytes(data, size);
  GIVEWAY_CHECK(giveway::fuzz::JudgeAll(bytes) == giveway::fuzz::JudgeAll(bytes));
  return 0;
}
