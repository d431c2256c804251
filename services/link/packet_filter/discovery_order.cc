#include "services/link/packet_filter/discovery_order.h"

#include <algorithm>
#include <array>

#include "services/link/packet_filter/submessage_check.h"

namespace giveway::link {
namespace {

constexpr std::size_t kLiveliness = 2;  // among the writers
constexpr std::array<std::array<std::uint8_t, 4>, ParticipantTable::kOrderedWriters> kWriters = {
    {{0, 0, 0x03, 0xc2}, {0, 0, 0x04, 0xc2}, {0, 0x02, 0, 0xc2}}};

constexpr std::size_t kFirstAt = 8;  // of HEARTBEAT, GAP and ACKNACK: a number
constexpr std::size_t kBaseInGap = 16;
constexpr std::size_t kBitsInGap = 24;
constexpr std::size_t kLeastAckNack = 24;  // bytes

constexpr std::int64_t kUnknownAtOnce = 1024;  // of the slowest start of the largest fleet
constexpr std::int64_t kUnknownPerSecond = 16;

std::optional<std::size_t> WriterIn(const Submessage& part, std::size_t at) {
  const auto writer = std::ranges::find_if(kWriters, [&](const auto& entity) {
    return std::equal(entity.begin(), entity.end(),
                      part.body.begin() + static_cast<std::ptrdiff_t>(at));
  });
  if (writer == kWriters.end()) return std::nullopt;
  return static_cast<std::size_t>(writer - kWriters.begin());
}

std::optional<std::size_t> OrderedWriter(const Submessage& part) {
  switch (part.kind) {
    case SubmessageKind::kData:
    case SubmessageKind::kDataFrag:
      return WriterIn(part, kWriterInData);
    case SubmessageKind::kHeartbeat:
    case SubmessageKind::kGap:
      return WriterIn(part, kWriterAt);
    default:
      return std::nullopt;
  }
}

// Whether it is for that writer's reader, or for all: what names another one the library does not
// give to that reader.
bool IsForItsReader(const Submessage& part, std::size_t writer) {
  constexpr std::uint8_t kBuiltInReader = 0xc7;
  std::array<std::uint8_t, 4> reader = kWriters[writer];
  reader.back() = kBuiltInReader;
  const std::size_t at = part.kind == SubmessageKind::kData ? kReaderInData : 0;
  const Bytes named = part.body.subspan(at, reader.size());
  return std::ranges::equal(named, reader) ||
         std::ranges::all_of(named, [](std::uint8_t byte) { return byte == 0; });
}

// Calls visit(writer, submessage, participant) of each acknowledgement of such a writer's samples.
template <typename Visit>
void ForEachAcknowledgement(Bytes sent, Visit&& visit) {
  if (sent.size() <= kRtpsHeaderBytes) return;
  PacketContext context(sent);
  SubmessageWalk walk(sent);
  Submessage part;
  while (walk.Next(&part)) {
    if (part.kind == SubmessageKind::kInfoDst) {
      if (part.body.size() < context.destination.size()) return;
      context.Note(part);
    }
    if (part.kind != SubmessageKind::kAckNack || part.body.size() < kLeastAckNack) continue;
    const auto writer = WriterIn(part, kWriterAt);
    if (writer) visit(*writer, part, context.destination);
  }
}

// Of an ACKNACK: behind its bits, of which there are whole words. 0 where it ends early.
std::uint32_t CountOf(const Submessage& acknack) {
  const std::size_t at = kFirstAt + 12 + (std::size_t{acknack.U32(kFirstAt + 8)} + 31) / 32 * 4;
  return acknack.body.size() < at + 4 ? 0 : acknack.U32(at);
}

// Its key is the prefix of its participant and a kind, written as the last of four bytes: what the
// library makes an instance of, by the hash of the key or, without one, by the payload.
bool IsAssertion(const Submessage& data, const PrefixBytes& source) {
  constexpr std::uint16_t kKeyHash = 0x70;
  constexpr std::uint8_t kHighestKind = 3;
  constexpr std::size_t kKeyBytes = 16;
  const auto is_key = [&](Bytes key) {
    return key.size() == kKeyBytes && std::ranges::equal(source, key.first(source.size())) &&
           key[12] == 0 && key[13] == 0 && key[14] == 0 && key[15] <= kHighestKind;
  };
  if (data.Has(kWithKey)) return false;
  const Bytes hash = FindInlineParameter(data, kKeyHash);
  if (!hash.empty() && !is_key(hash)) return false;
  if (!data.Has(kWithData)) return !hash.empty();
  const Bytes payload = data.body.subspan(PayloadOfData(data));
  return payload.size() >= kEncapsulation + kKeyBytes &&
         payload.size() <= DiscoveryOrder::kMostAsserted &&
         is_key(payload.subspan(kEncapsulation, kKeyBytes));
}

// The numbers of a checked GAP that will not come. Of one without a range, which 3.1.2 ignores,
// none. False if they lie too far beyond a hole: the library notes each by itself.
bool SkipGap(const Submessage& gap, ArrivalWindow* window) {
  const std::int64_t start = gap.SequenceNumber(kFirstAt);
  const std::int64_t base = gap.SequenceNumber(kBaseInGap);
  const std::uint32_t bits = gap.U32(kBitsInGap);
  if (!window->MaySkip(start, base - 1 + bits)) return false;
  if (base <= start) return true;
  window->Skip(start, base - 1);
  for (std::uint32_t i = 0; i < bits; ++i) {
    const std::uint32_t word = gap.U32(kBitsInGap + 4 + 4 * std::size_t{i / 32});
    if ((word >> (31 - i % 32) & 1U) != 0) window->Skip(base + i, base + i);
  }
  return true;
}

}  // namespace

bool IsOfDiscoveryOrder(const Submessage& submessage) {
  return OrderedWriter(submessage).has_value();
}

bool AcknowledgesDiscovery(Bytes sent) {
  bool acknowledges = false;
  ForEachAcknowledgement(sent, [&](auto&&...) { acknowledges = true; });
  return acknowledges;
}

DiscoveryOrder::DiscoveryOrder(ParticipantTable& participants)
    : participants_(participants), of_unknown_(kUnknownAtOnce, kUnknownPerSecond) {}

PacketDrop DiscoveryOrder::Check(Bytes packet, SteadyTime now) {
  touched_.clear();
  PacketContext context(packet);
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    context.Note(part);
    const PacketDrop drop = CheckPart(part, context, now);
    if (drop != PacketDrop::kNone) return drop;
  }
  for (const auto& [kept, touched] : touched_) *kept = touched;
  return PacketDrop::kNone;
}

// What goes to another participant the library does not read.
bool DiscoveryOrder::IsForOthers(const PacketContext& context) const {
  return own_.has_value() && context.destination != PrefixBytes{} && context.destination != *own_;
}

PacketDrop DiscoveryOrder::CheckPart(const Submessage& part, const PacketContext& context,
                                     SteadyTime now) {
  const std::optional<std::size_t> writer = OrderedWriter(part);
  if (!writer || IsForOthers(context)) return PacketDrop::kNone;
  const PrefixBytes source = context.Source();
  const bool is_data = part.kind == SubmessageKind::kData;
  if (part.kind == SubmessageKind::kDataFrag) return PacketDrop::kFragmentedAnnouncement;
  if (!IsForItsReader(part, *writer)) return PacketDrop::kNone;
  if (is_data && *writer == kLiveliness && !IsAssertion(part, source))
    return PacketDrop::kMalformed;
  ArrivalWindow* const window = Touch(source, *writer);
  if (window == nullptr) {
    return !is_data || of_unknown_.Take(now) ? PacketDrop::kNone : PacketDrop::kTooManyStrangers;
  }
  if (part.kind == SubmessageKind::kGap && !SkipGap(part, window)) return PacketDrop::kSequenceJump;
  if (part.kind == SubmessageKind::kHeartbeat) {
    window->Hear(part.SequenceNumber(kFirstAt), part.U32(kCountInHeartbeat));
  }
  const bool is_near =
      !is_data || window->Take(part.SequenceNumber(kNumberInData), part.body.size());
  return is_near ? PacketDrop::kNone : PacketDrop::kSequenceJump;
}

// The copy that this packet changes; null: the participant is not known.
ArrivalWindow* DiscoveryOrder::Touch(const PrefixBytes& participant, std::size_t writer) {
  ArrivalWindow* const kept = participants_.WindowOf(participant, writer);
  if (kept == nullptr) return nullptr;
  const auto touched = std::ranges::find(touched_, kept, [](const auto& one) { return one.first; });
  if (touched != touched_.end()) return &touched->second;
  return &touched_.emplace_back(kept, *kept).second;
}

// The first number that it acknowledges not to have is the one behind all that it has.
void DiscoveryOrder::HearOwn(Bytes sent) {
  own_ = PacketContext(sent).Source();
  ForEachAcknowledgement(
      sent, [&](std::size_t writer, const Submessage& acknack, const PrefixBytes& participant) {
        ArrivalWindow* const window = participants_.WindowOf(participant, writer);
        const std::int64_t missing = acknack.SequenceNumber(kFirstAt);
        // Number 0: it has heard no HEARTBEAT, which says nothing of what has come.
        if (window != nullptr && missing > 0) window->Acknowledge(missing - 1, CountOf(acknack));
      });
}

}  // namespace giveway::link
