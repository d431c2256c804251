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

// Where the number by which a writer goes, and other counts, stand in other bodies.
constexpr std::size_t kStartAt = 8;         // of a GAP
constexpr std::size_t kLastNumberAt = 16;   // of HEARTBEAT and GAP
constexpr std::size_t kBitsInAckNack = 16;  // how many; the bits, and behind them the count
constexpr std::size_t kBitsInNackFrag = 20;

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

}  // namespace

PacketFilter::PacketFilter(const PacketFilterOptions& options)
    : options_(options),
      writers_(options.writers != 0 ? options.writers : WritersOf(options.fleet_size), options.seed,
               options.fleet_size, options.of_all_bodies),
      participants_(options.strangers, options.fleet_size) {}

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
  PacketVerdict verdict{PacketDrop::kNone, packet.size()};
  std::int64_t skipped = 0;  // by GAPs of users' writers
  bool has_gaps_of_order = false;
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    const auto kind = static_cast<std::uint8_t>(part.kind);
    if (ours && kind == kStatisticsKind) {
      const bool as_written = part.stated_length == kStatisticsBytes && walk.IsAtEnd() &&
                              part.body.size() == kStatisticsBytes;
      const bool alone = walk.Start() == kRtpsHeaderBytes;
      if (!as_written || alone) return {PacketDrop::kStatistics};
      verdict.bytes = walk.Start();
      return verdict;
    }
    // To the library another vendor's own kinds are nothing.
    if (!ours && kind >= static_cast<std::uint8_t>(SubmessageKind::kVendorFirst)) continue;
    const bool secure =
        part.kind >= SubmessageKind::kSecureFirst && part.kind <= SubmessageKind::kSecureLast;
    if (options_.secured && secure) continue;
    PacketDrop drop = CheckSubmessage(part, options_.largest_sample);
    const bool is_long_gap = drop == PacketDrop::kRangeTooLong;  // and sound but for that
    if (drop != PacketDrop::kNone && !is_long_gap) return {drop};
    if (IsOfDiscovery(part)) {
      verdict.announces = true;
      drop = CheckDiscovery(part, options_.secured);
    }
    if (part.kind == SubmessageKind::kGap) {
      if (IsOfDiscoveryOrder(part)) {
        has_gaps_of_order = true;
      } else {
        skipped += part.SequenceNumber(kLastNumberAt) - part.SequenceNumber(kStartAt);
        drop = PacketDrop::kNone;
      }
    }
    if (drop != PacketDrop::kNone) return {drop};
    verdict.has_long_gaps |= skipped > kLongestGap;
    verdict.has_fragments |= part.kind == SubmessageKind::kDataFrag;
  }
  if (walk.IsBroken()) return {PacketDrop::kListTooLong};
  // What is shortened must not be what the window of a discovery writer counts in full: a sender
  // has one writer a packet, or discovery's alone.
  if (verdict.has_long_gaps && has_gaps_of_order) return {PacketDrop::kRangeTooLong};
  return verdict;
}

// By what is known of the writers it is from.
PacketDrop PacketFilter::CheckWriters(Bytes packet, SteadyTime now) {
  PacketContext context(packet);
  bool is_ordered = false;
  bool says_farewell = false;
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    context.Note(part);
    is_ordered |= IsOfDiscoveryOrder(part);
    const PacketDrop drop = CheckWriter(part, context, now);
    if (drop != PacketDrop::kNone) return drop;
    if (!IsNextCount(part, context.source, now)) return PacketDrop::kSequenceJump;
    says_farewell |= IsAnnouncement(part) && IsFarewell(part);
  }
  const PacketDrop drop = is_ordered ? order_.Check(packet, now) : PacketDrop::kNone;
  if (says_farewell && drop == PacketDrop::kNone) EndParticipants(packet);
  return drop;
}

void PacketFilter::EndParticipants(Bytes packet) {
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    if (!IsAnnouncement(part) || !IsFarewell(part)) continue;
    if (const auto ended = EndedParticipant(part)) participants_.End(*ended);
  }
}

PacketDrop PacketFilter::CheckWriter(const Submessage& submessage, const PacketContext& context,
                                     SteadyTime now) {
  const bool is_data =
      submessage.kind == SubmessageKind::kData || submessage.kind == SubmessageKind::kDataFrag;
  const bool is_gap = submessage.kind == SubmessageKind::kGap;
  if (!is_data && !is_gap && submessage.kind != SubmessageKind::kHeartbeat)
    return PacketDrop::kNone;
  const std::uint8_t* const entity = submessage.body.data() + (is_data ? kWriterInData : kWriterAt);
  if (IsAnnouncement(submessage)) {
    const PacketDrop drop = CheckAnnouncement(submessage, context, now);
    if (drop != PacketDrop::kNone) return drop;
  }
  std::int64_t number = submessage.SequenceNumber(is_data ? kNumberInData : kLastNumberAt);
  if (is_gap) --number;                       // the last one that will not come
  if (number <= 0) return PacketDrop::kNone;  // a writer that has written nothing
  const Statement by = is_data ? Statement::kSample : Statement::kRange;
  if (!writers_.IsPlausible(GuidOf(context.source, entity), number, by, now)) {
    return PacketDrop::kSequenceJump;
  }
  const bool may_add = !IsOfDiscovery(submessage) || MayAdd(submessage, now);
  return may_add ? PacketDrop::kNone : PacketDrop::kTooManyEndpoints;
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

// A discovery server sends the announcements of others: it is the payload that names the
// participant or endpoint. Of each source of them the library keeps a record too, before it reads
// their names; of a farewell only where it knows the participant.
PacketDrop PacketFilter::CheckAnnouncement(const Submessage& announcement,
                                           const PacketContext& context, SteadyTime now) {
  if (IsFarewell(announcement)) return PacketDrop::kNone;
  const std::optional<PrefixBytes> named = AnnouncedParticipant(announcement);
  if (!named || !announcement.Has(kWithData)) return PacketDrop::kMalformed;
  const PrefixBytes source = context.Source();
  const bool may_join = participants_.MayJoin(source, now) &&
                        (*named == source || participants_.MayJoin(*named, now));
  return may_join ? PacketDrop::kNone : PacketDrop::kTooManyStrangers;
}

bool PacketFilter::MayAdd(const Submessage& of_discovery, SteadyTime now) {
  if (IsAnnouncement(of_discovery)) return true;  // of no endpoint
  if (const auto ended = EndedEndpoint(of_discovery)) participants_.Remove(*ended);
  const std::optional<EndpointGuid> endpoint = AnnouncedEndpoint(of_discovery);
  return !endpoint.has_value() || participants_.MayAdd(*endpoint, now);
}

}  // namespace giveway::link
