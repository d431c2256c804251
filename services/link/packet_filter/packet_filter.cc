#include "services/link/packet_filter/packet_filter.h"

#include <algorithm>
#include <array>

#include "services/link/packet_filter/announcement.h"
#include "services/link/packet_filter/discovery_list.h"
#include "services/link/packet_filter/submessage_check.h"

namespace giveway::link {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic = {'R', 'T', 'P', 'S'};
constexpr std::size_t kVersionAt = 4;
constexpr std::size_t kVendorAt = 6;
constexpr std::uint8_t kMajorVersion = 2;
constexpr std::array<std::uint8_t, 2> kEProsima = {0x01, 0x0f};

// What Fast DDS appends to each packet: the size of its structure, in big-endian order.
constexpr std::uint8_t kStatisticsKind = 0x80;
constexpr std::uint16_t kStatisticsBytes = 56;

// For whole fleets that start, with some twenty writers of each vehicle besides its announcements,
// and as many readers and writers that count what they send.
constexpr std::size_t kWritersAVehicle = 48;
constexpr std::size_t kWritersAtLeast = 4096;
constexpr std::size_t kWritersAtMost = 131072;

// Where a writer's entity id and the number by which it goes stand in other bodies.
constexpr std::size_t kWriterAt = 4;  // of HEARTBEAT and GAP
constexpr std::size_t kLastNumberAt = 16;
constexpr std::size_t kCountInHeartbeat = 24;
constexpr std::size_t kBitsInAckNack = 16;  // how many; the bits, and behind them the count
constexpr std::size_t kBitsInNackFrag = 20;
constexpr std::size_t kPrefixInInfoSrc = 8;

bool IsRtps(Bytes packet) {
  return packet.size() > kRtpsHeaderBytes &&
         std::equal(kMagic.begin(), kMagic.end(), packet.begin()) &&
         packet[kVersionAt] == kMajorVersion;
}

bool IsLoopback(std::uint32_t source) { return source >> 24U == 127; }

std::size_t WritersOf(std::uint32_t fleet_size) {
  return std::clamp(fleet_size * kWritersAVehicle, kWritersAtLeast, kWritersAtMost);
}

WriterGuid GuidOf(const std::uint8_t* prefix, const std::uint8_t* entity) {
  WriterGuid guid;
  std::copy_n(prefix, sizeof(PrefixBytes), guid.begin());
  std::copy_n(entity, guid.size() - sizeof(PrefixBytes), guid.begin() + sizeof(PrefixBytes));
  return guid;
}

// Where the count of what is sent again and again stands; 0: it has none.
std::size_t CountAt(const Submessage& submessage) {
  const auto behind_bits = [&](std::size_t at) {
    return at + 4 + 4 * ((submessage.U32(at) + std::size_t{31}) / 32);
  };
  switch (submessage.kind) {
    case SubmessageKind::kHeartbeat:
      return kCountInHeartbeat;
    case SubmessageKind::kAckNack:
      return behind_bits(kBitsInAckNack);
    case SubmessageKind::kNackFrag:
      return behind_bits(kBitsInNackFrag);
    default:
      return 0;
  }
}

// The counting endpoint: a writer, or a reader towards one writer. By kind, since each has a count
// of its own.
WriterGuid CounterGuid(const Submessage& submessage, const std::uint8_t* prefix) {
  WriterGuid guid = GuidOf(prefix, submessage.body.data() + kWriterAt);
  guid[0] ^= static_cast<std::uint8_t>(submessage.kind);
  if (submessage.kind == SubmessageKind::kHeartbeat) return guid;
  for (std::size_t i = 0; i < 4; ++i) {  // turned, so that like ids do not cancel each other
    guid[sizeof(PrefixBytes) + i] ^= submessage.body[(i + 1) % 4];
  }
  return guid;
}

// New participants that may come at once: all of a fleet, twice, and strangers.
std::int64_t AtOnce(const PacketFilterOptions& options) {
  return options.strangers + 2 * std::int64_t{options.fleet_size};
}

}  // namespace

PacketFilter::PacketFilter(const PacketFilterOptions& options)
    : options_(options),
      writers_(options.writers != 0 ? options.writers : WritersOf(options.fleet_size), options.seed,
               options.fleet_size, options.of_all_bodies),
      tokens_(AtOnce(options)) {}

PacketVerdict PacketFilter::Check(Bytes packet, std::uint32_t source, SteadyTime now) {
  if (options_.loopback_only && !IsLoopback(source)) return {PacketDrop::kForeignSource};
  if (!IsRtps(packet)) return {PacketDrop::kNotRtps};
  PacketVerdict verdict = CheckParts(packet);
  if (verdict.drop != PacketDrop::kNone) return verdict;
  verdict.drop = CheckWriters(packet.first(verdict.bytes), now);
  return verdict;
}

// By itself, whatever came before.
PacketVerdict PacketFilter::CheckParts(Bytes packet) const {
  const bool ours = std::equal(kEProsima.begin(), kEProsima.end(), packet.begin() + kVendorAt);
  bool announces = false;
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    const auto kind = static_cast<std::uint8_t>(part.kind);
    if (ours && kind == kStatisticsKind) {
      const bool as_written = part.stated_length == kStatisticsBytes && walk.IsAtEnd() &&
                              part.body.size() == kStatisticsBytes;
      const bool alone = walk.Start() == kRtpsHeaderBytes;
      if (!as_written || alone) return {PacketDrop::kStatistics};
      return {PacketDrop::kNone, walk.Start(), announces};
    }
    // To the library another vendor's own kinds are nothing.
    if (!ours && kind >= static_cast<std::uint8_t>(SubmessageKind::kVendorFirst)) continue;
    const bool secure =
        part.kind >= SubmessageKind::kSecureFirst && part.kind <= SubmessageKind::kSecureLast;
    if (options_.secured && secure) continue;
    PacketDrop drop = CheckSubmessage(part, options_.largest_sample);
    if (drop == PacketDrop::kNone && IsOfDiscovery(part)) {
      announces = true;
      drop = CheckDiscovery(part, options_.secured);
    }
    if (drop != PacketDrop::kNone) return {drop};
  }
  return {walk.IsBroken() ? PacketDrop::kListTooLong : PacketDrop::kNone, packet.size(), announces};
}

// By what is known of the writers it is from.
PacketDrop PacketFilter::CheckWriters(Bytes packet, SteadyTime now) {
  const std::uint8_t* prefix = packet.data() + kSenderAt;
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    if (part.kind == SubmessageKind::kInfoSrc) prefix = part.body.data() + kPrefixInInfoSrc;
    const PacketDrop drop = CheckWriter(part, prefix, now);
    if (drop != PacketDrop::kNone) return drop;
    if (!IsNextCount(part, prefix, now)) return PacketDrop::kSequenceJump;
  }
  return PacketDrop::kNone;
}

PacketDrop PacketFilter::CheckWriter(const Submessage& submessage, const std::uint8_t* prefix,
                                     SteadyTime now) {
  const bool is_data =
      submessage.kind == SubmessageKind::kData || submessage.kind == SubmessageKind::kDataFrag;
  const bool is_gap = submessage.kind == SubmessageKind::kGap;
  if (!is_data && !is_gap && submessage.kind != SubmessageKind::kHeartbeat)
    return PacketDrop::kNone;
  const std::uint8_t* const entity = submessage.body.data() + (is_data ? kWriterInData : kWriterAt);
  if (IsAnnouncement(submessage) && !IsWelcome(submessage, now)) {
    return PacketDrop::kTooManyStrangers;
  }
  std::int64_t number = submessage.SequenceNumber(is_data ? kNumberInData : kLastNumberAt);
  if (is_gap) --number;                       // the last one that will not come
  if (number <= 0) return PacketDrop::kNone;  // a writer that has written nothing
  const Statement by = is_data ? Statement::kSample : Statement::kRange;
  const bool plausible = writers_.IsPlausible(GuidOf(prefix, entity), number, by, now);
  return plausible ? PacketDrop::kNone : PacketDrop::kSequenceJump;
}

// The library ignores each HEARTBEAT, ACKNACK and NACK_FRAG whose count is not above all before:
// one forged count of 2^32 - 1, and those of the true sender never count again.
bool PacketFilter::IsNextCount(const Submessage& submessage, const std::uint8_t* prefix,
                               SteadyTime now) {
  const std::size_t at = CountAt(submessage);
  const std::uint32_t count = at == 0 ? 0 : submessage.U32(at);
  if (count == 0) return true;
  return writers_.IsPlausible(CounterGuid(submessage, prefix), count, Statement::kCount, now);
}

// An announcement of a participant that is known, or of a new one while there is space. A discovery
// server sends those of others: it is the payload that names the participant.
bool PacketFilter::IsWelcome(const Submessage& announcement, SteadyTime now) {
  const std::optional<PrefixBytes> prefix = AnnouncedParticipant(announcement);
  if (!prefix.has_value()) return true;  // of one that leaves: announces no participant
  const WriterGuid participant = GuidOf(prefix->data(), kParticipantEntity.data());
  if (writers_.Knows(participant, now)) return true;
  if (!TakeToken(now)) return false;
  writers_.Add(participant, now);
  return true;
}

bool PacketFilter::TakeToken(SteadyTime now) {
  constexpr Nanoseconds kApart =
      std::chrono::nanoseconds(std::chrono::seconds(1)) / kStrangersPerSecond;
  const std::int64_t most = AtOnce(options_);
  if (token_due_ == SteadyTime{0}) token_due_ = now + kApart;
  if (now >= token_due_) {
    const std::int64_t due = 1 + (now - token_due_) / kApart;
    tokens_ = std::min(most, tokens_ + std::min(due, most));
    token_due_ += due * kApart;
  }
  if (tokens_ == 0) return false;
  --tokens_;
  return true;
}

}  // namespace giveway::link
