#include "services/link/packet_filter/submessage_check.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace giveway::link {
namespace {

constexpr std::uint8_t kFragOfKey = 0x04;   // of DATA_FRAG
constexpr std::uint8_t kInvalidate = 0x02;  // of INFO_TS: there is none

constexpr std::uint16_t kFilterInfo = 0x0055;  // which readers' filters a sample passes

constexpr std::size_t kToQosAt =
    2;  // of DATA and DATA_FRAG: octets from behind it to the inline QoS
constexpr std::size_t kBehindToQos = 4;
constexpr std::uint16_t kMostToQos = 0x7fff;  // the library reads a signed number
constexpr std::size_t kLocatorBytes = 24;
constexpr std::uint32_t kMostBits = 256;  // of a set of numbers
// Beyond it nothing can be added to a sequence number without care.
constexpr std::int64_t kHighestNumber = std::int64_t{1} << 62U;

bool IsNumber(std::int64_t number) { return number > 0 && number <= kHighestNumber; }

// Where the list ends that starts at `at`: behind its sentinel. Nothing if it does not end here.
std::optional<std::size_t> EndOfParameters(const Submessage& of, std::size_t at) {
  while (at + kParameterHeader <= of.body.size()) {
    const std::uint16_t id = of.U16(at);
    const std::size_t length = Padded(of.U16(at + 2));
    at += kParameterHeader;
    if (id == kSentinel) return at;
    if (length > of.body.size() - at) return std::nullopt;
    at += length;
  }
  return std::nullopt;
}

// Where the payload of a DATA or DATA_FRAG starts, whose fields take `fields` octets.
std::optional<std::size_t> EndOfInlineQos(const Submessage& data, std::size_t fields) {
  const std::uint16_t to_qos = data.U16(kToQosAt);
  const std::size_t qos = kBehindToQos + to_qos;
  if (to_qos > kMostToQos || qos < fields || qos > data.body.size()) return std::nullopt;
  return data.Has(kInlineQos) ? EndOfParameters(data, qos) : qos;
}

// No writer of a fleet evaluates the filters of readers. The library takes a sample so marked into
// a history before it is asked, where one of an invented key evicts others.
bool IsMarked(const Submessage& data) {
  return FindInlineParameter(data, kFilterInfo).data() != nullptr;
}

constexpr std::size_t kDataFields = 20;
constexpr std::size_t kDataFragFields = 32;

PacketDrop CheckData(const Submessage& data) {
  if (data.body.size() < kDataFields) return PacketDrop::kMalformed;
  const bool has_payload = data.Has(kWithData) || data.Has(kWithKey);
  if (data.Has(kWithData) && data.Has(kWithKey)) return PacketDrop::kMalformed;
  if (!IsNumber(data.SequenceNumber(kNumberInData))) return PacketDrop::kMalformed;
  const auto payload = EndOfInlineQos(data, kDataFields);
  if (!payload) return PacketDrop::kListTooLong;
  const bool too_short = has_payload && data.body.size() - *payload < kEncapsulation;
  return too_short || IsMarked(data) ? PacketDrop::kMalformed : PacketDrop::kNone;
}

// The bytes that these are of their sample; 0 where they are not of it.
std::uint64_t BytesOf(const Fragment& fragment) {
  if (fragment.first == 0 || fragment.count == 0 || fragment.fragment_bytes == 0) return 0;
  const std::uint64_t before = (fragment.first - std::uint64_t{1}) * fragment.fragment_bytes;
  const std::uint64_t wanted = std::uint64_t{fragment.count} * fragment.fragment_bytes;
  if (before >= fragment.sample_bytes) return 0;
  const std::uint64_t left = fragment.sample_bytes - before;
  // All but the last fragment must be whole.
  return wanted < left + fragment.fragment_bytes ? std::min(wanted, left) : 0;
}

PacketDrop CheckDataFrag(const Submessage& frag, std::uint32_t largest_sample) {
  if (frag.body.size() < kDataFragFields || frag.Has(kFragOfKey)) return PacketDrop::kMalformed;
  if (!IsNumber(frag.SequenceNumber(kNumberInData))) return PacketDrop::kMalformed;
  const Fragment fragment = FragmentOf(frag);
  if (fragment.sample_bytes > largest_sample) return PacketDrop::kSampleTooLarge;
  if (fragment.sample_bytes < kLeastFragmented) return PacketDrop::kMalformed;
  if (fragment.fragment_bytes < kLeastFragment) return PacketDrop::kMalformed;
  const auto payload = EndOfInlineQos(frag, kDataFragFields);
  if (!payload) return PacketDrop::kListTooLong;
  const std::uint64_t wanted = BytesOf(fragment);
  const std::size_t there = frag.body.size() - *payload;
  const bool fits = wanted > 0 && there >= wanted && there <= Padded(wanted) && !IsMarked(frag);
  return fits ? PacketDrop::kNone : PacketDrop::kMalformed;
}

PacketDrop CheckHeartbeat(const Submessage& heartbeat) {
  if (heartbeat.body.size() < 28) return PacketDrop::kMalformed;
  const std::int64_t first = heartbeat.SequenceNumber(8);
  const std::int64_t last = heartbeat.SequenceNumber(16);
  const bool sound = IsNumber(first) && last >= first - 1 && last <= kHighestNumber;
  return sound ? PacketDrop::kNone : PacketDrop::kMalformed;
}

// The bits of a set of numbers whose count stands at `at`, and `behind` more octets. `behind` may
// be less than what a later version of the protocol appends.
PacketDrop CheckBits(const Submessage& of, std::size_t at, std::size_t behind) {
  const std::uint32_t bits = of.U32(at);
  if (bits > kMostBits) return PacketDrop::kListTooLong;
  const std::size_t end = at + 4 + 4 * std::size_t{(bits + 31) / 32} + behind;
  return end <= of.body.size() ? PacketDrop::kNone : PacketDrop::kListTooLong;
}

constexpr std::size_t kStartOfGapAt = 8;
constexpr std::size_t kBaseOfGapAt = 16;
constexpr std::size_t kBitsOfGapAt = 24;

PacketDrop CheckGap(const Submessage& gap) {
  if (gap.body.size() < 28) return PacketDrop::kMalformed;
  const std::int64_t start = gap.SequenceNumber(kStartOfGapAt);
  const std::int64_t base = gap.SequenceNumber(kBaseOfGapAt);
  if (!IsNumber(start) || !IsNumber(base) || base < start) return PacketDrop::kMalformed;
  const PacketDrop drop = CheckBits(gap, kBitsOfGapAt, 0);
  if (drop != PacketDrop::kNone) return drop;
  return base - start > kLongestGap ? PacketDrop::kRangeTooLong : PacketDrop::kNone;
}

PacketDrop CheckAckNack(const Submessage& acknack) {
  if (acknack.body.size() < 24) return PacketDrop::kMalformed;
  const std::int64_t base = acknack.SequenceNumber(8);
  if (base < 0 || base > kHighestNumber) return PacketDrop::kMalformed;
  return CheckBits(acknack, 16, 4);
}

// From the fragment that is asked for, which it never compares with the sample, the library
// computes where to read: of fragment 0, 4 GB behind the sample. Nor may the bits reach 0 again.
constexpr std::uint32_t kHighestFragment = std::uint32_t{1} << 31U;

PacketDrop CheckNackFrag(const Submessage& nack) {
  if (nack.body.size() < 28) return PacketDrop::kMalformed;
  if (!IsNumber(nack.SequenceNumber(8))) return PacketDrop::kMalformed;
  const std::uint32_t first = nack.U32(16);
  if (first == 0 || first > kHighestFragment) return PacketDrop::kMalformed;
  return CheckBits(nack, 20, 4);
}

PacketDrop CheckInfoReply(const Submessage& reply) {
  if (reply.body.size() < 4) return PacketDrop::kMalformed;
  const std::size_t room = (reply.body.size() - 4) / kLocatorBytes;
  return reply.U32(0) <= room ? PacketDrop::kNone : PacketDrop::kListTooLong;
}

PacketDrop AtLeast(const Submessage& submessage, std::size_t bytes) {
  return submessage.body.size() >= bytes ? PacketDrop::kNone : PacketDrop::kMalformed;
}

}  // namespace

PacketDrop CheckSubmessage(const Submessage& submessage, std::uint32_t largest_sample) {
  switch (submessage.kind) {
    case SubmessageKind::kData:
      return CheckData(submessage);
    case SubmessageKind::kDataFrag:
      return CheckDataFrag(submessage, largest_sample);
    case SubmessageKind::kHeartbeat:
      return CheckHeartbeat(submessage);
    case SubmessageKind::kGap:
      return CheckGap(submessage);
    case SubmessageKind::kAckNack:
      return CheckAckNack(submessage);
    case SubmessageKind::kNackFrag:
      return CheckNackFrag(submessage);
    case SubmessageKind::kHeartbeatFrag:
      return AtLeast(submessage, 24);
    case SubmessageKind::kInfoTs:
      return AtLeast(submessage, submessage.Has(kInvalidate) ? 0 : 8);
    case SubmessageKind::kInfoDst:
      return AtLeast(submessage, 12);
    case SubmessageKind::kInfoSrc:
      return AtLeast(submessage, 20);
    case SubmessageKind::kInfoReply:
      return CheckInfoReply(submessage);
    case SubmessageKind::kInfoReplyIp4:
      return AtLeast(submessage, 8);
    case SubmessageKind::kPad:
      return PacketDrop::kNone;
    default:
      return PacketDrop::kUnknownKind;
  }
}

void ShortenGaps(std::span<std::uint8_t> packet) {
  std::int64_t left = kLongestGap;
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    if (part.kind != SubmessageKind::kGap) continue;
    const std::int64_t start = part.SequenceNumber(kStartOfGapAt);
    const std::int64_t numbers = part.SequenceNumber(kBaseOfGapAt) - start;
    if (numbers <= left) {
      left -= numbers;
      continue;
    }
    const auto base = static_cast<std::uint64_t>(start + left);
    left = 0;
    const std::size_t base_at = walk.Start() + kSubmessageHeaderBytes + kBaseOfGapAt;
    const std::array<std::uint32_t, 3> words = {static_cast<std::uint32_t>(base >> 32U),
                                                static_cast<std::uint32_t>(base), 0};  // no bits
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::uint32_t word = part.IsLittleEndian() ? words[i] : __builtin_bswap32(words[i]);
      std::memcpy(packet.data() + base_at + i * sizeof word, &word, sizeof word);
    }
  }
}

Fragment FragmentOf(const Submessage& frag) {
  return {.number = frag.SequenceNumber(kNumberInData),
          .first = frag.U32(20),
          .count = frag.U16(24),
          .sample_bytes = frag.U32(28),
          .fragment_bytes = frag.U16(26)};
}

InlineAndPayload PartsOfFragment(const Submessage& frag) {
  const std::size_t qos = kBehindToQos + frag.U16(kToQosAt);
  const std::size_t payload = EndOfInlineQos(frag, kDataFragFields).value_or(frag.body.size());
  return {frag.body.subspan(qos, payload - qos), frag.body.subspan(payload)};
}

std::size_t PayloadOfData(const Submessage& data) {
  return EndOfInlineQos(data, kDataFields).value_or(data.body.size());
}

std::optional<Submessage> ParametersOf(const Submessage& data) {
  constexpr std::uint8_t kListBigEndian = 2;  // second octet of the encapsulation
  constexpr std::uint8_t kListLittleEndian = 3;
  if (!data.Has(kWithData | kWithKey)) return std::nullopt;
  const Bytes payload = data.body.subspan(PayloadOfData(data));
  if (payload.size() < kEncapsulation) return std::nullopt;
  if (payload[1] != kListBigEndian && payload[1] != kListLittleEndian) return std::nullopt;
  Submessage list;
  list.flags = payload[1] & 1U;
  list.body = payload.subspan(kEncapsulation);
  return list;
}

Bytes FindParameter(const Submessage& submessage, std::size_t list, std::uint16_t id) {
  while (list + kParameterHeader <= submessage.body.size()) {
    const std::uint16_t found = submessage.U16(list);
    const std::size_t length = submessage.U16(list + 2);
    list += kParameterHeader;
    if (found == kSentinel || length > submessage.body.size() - list) break;
    if (found == id) return submessage.body.subspan(list, length);
    list += Padded(length);
  }
  return {};
}

Bytes FindInlineParameter(const Submessage& data, std::uint16_t id) {
  if (!data.Has(kInlineQos)) return {};
  return FindParameter(data, kBehindToQos + data.U16(kToQosAt), id);
}

}  // namespace giveway::link
