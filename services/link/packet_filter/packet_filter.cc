#include "services/link/packet_filter/packet_filter.h"

#include <algorithm>
#include <array>

#include "services/link/packet_filter/announcement.h"
#include "services/link/packet_filter/submessage_check.h"

namespace giveway::link {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic = {'R', 'T', 'P', 'S'};
constexpr std::size_t kVersionAt = 4;
constexpr std::size_t kVendorAt = 6;
constexpr std::size_t kPrefixAt = 8;
constexpr std::size_t kPrefixBytes = 12;
constexpr std::uint8_t kMajorVersion = 2;
constexpr std::array<std::uint8_t, 2> kEProsima = {0x01, 0x0f};

// What Fast DDS appends to each packet: the size of its structure, in big-endian order.
constexpr std::uint8_t kStatisticsKind = 0x80;
constexpr std::uint16_t kStatisticsBytes = 56;

// Of whole fleets that start, and of each vehicle some twenty writers beside its announcements.
constexpr std::size_t kWritersAVehicle = 24;
constexpr std::size_t kWritersAtLeast = 2048;
constexpr std::size_t kWritersAtMost = 65536;

// Where a writer's entity id and the number by which it goes stand in a body.
constexpr std::size_t kWriterAtInData = 8;
constexpr std::size_t kNumberAtInData = 12;
constexpr std::size_t kWriterAt = 4;  // of HEARTBEAT and GAP
constexpr std::size_t kLastNumberAt = 16;
constexpr std::size_t kPrefixInInfoSrc = 8;

constexpr std::array<std::uint8_t, 4> kParticipant = {0x00, 0x00, 0x01, 0xc1};

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
  std::copy_n(prefix, kPrefixBytes, guid.begin());
  std::copy_n(entity, guid.size() - kPrefixBytes, guid.begin() + kPrefixBytes);
  return guid;
}

}  // namespace

PacketFilter::PacketFilter(const PacketFilterOptions& options)
    : options_(options),
      writers_(WritersOf(options.fleet_size), options.seed),
      tokens_(kStrangersAtOnce + 2 * std::int64_t{options.fleet_size}) {}

PacketVerdict PacketFilter::Judge(Bytes packet, std::uint32_t source, SteadyTime now) {
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
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    const auto kind = static_cast<std::uint8_t>(part.kind);
    if (ours && kind == kStatisticsKind) {
      const bool as_written = part.stated_length == kStatisticsBytes && walk.IsAtEnd() &&
                              part.body.size() == kStatisticsBytes;
      const bool alone = walk.Start() == kRtpsHeaderBytes;
      if (!as_written || alone) return {PacketDrop::kStatistics};
      return {PacketDrop::kNone, walk.Start()};
    }
    // To the library another vendor's own kinds are nothing.
    if (!ours && kind >= static_cast<std::uint8_t>(SubmessageKind::kVendorFirst)) continue;
    const bool secure =
        part.kind >= SubmessageKind::kSecureFirst && part.kind <= SubmessageKind::kSecureLast;
    if (options_.secured && secure) continue;
    const PacketDrop drop = CheckSubmessage(part, options_.largest_sample);
    if (drop != PacketDrop::kNone) return {drop};
  }
  return {walk.IsBroken() ? PacketDrop::kListTooLong : PacketDrop::kNone, packet.size()};
}

// By what is known of the writers it is from.
PacketDrop PacketFilter::CheckWriters(Bytes packet, SteadyTime now) {
  const std::uint8_t* prefix = packet.data() + kPrefixAt;
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    if (part.kind == SubmessageKind::kInfoSrc) prefix = part.body.data() + kPrefixInInfoSrc;
    const PacketDrop drop = CheckWriter(part, prefix, now);
    if (drop != PacketDrop::kNone) return drop;
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
  const std::uint8_t* const entity =
      submessage.body.data() + (is_data ? kWriterAtInData : kWriterAt);
  if (IsAnnouncement(submessage) && !IsWelcome(submessage, now)) {
    return PacketDrop::kTooManyStrangers;
  }
  std::int64_t number = submessage.SequenceNumber(is_data ? kNumberAtInData : kLastNumberAt);
  if (is_gap) --number;                       // the last one that will not come
  if (number <= 0) return PacketDrop::kNone;  // a writer that has written nothing
  const bool plausible = writers_.IsPlausible(GuidOf(prefix, entity), number, now);
  return plausible ? PacketDrop::kNone : PacketDrop::kSequenceJump;
}

// An announcement of a participant that is known, or of a new one while there is room. A discovery
// server sends those of others: it is the payload that names the participant.
bool PacketFilter::IsWelcome(const Submessage& announcement, SteadyTime now) {
  const std::optional<PrefixBytes> prefix = AnnouncedParticipant(announcement);
  if (!prefix.has_value()) return true;  // of one that leaves; names nobody new
  const WriterGuid participant = GuidOf(prefix->data(), kParticipant.data());
  if (writers_.Knows(participant, now)) return true;
  if (!TakeToken(now)) return false;
  writers_.Add(participant, now);
  return true;
}

bool PacketFilter::TakeToken(SteadyTime now) {
  constexpr Nanoseconds kApart =
      std::chrono::nanoseconds(std::chrono::seconds(1)) / kStrangersPerSecond;
  const std::int64_t most = kStrangersAtOnce + 2 * std::int64_t{options_.fleet_size};
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
