#include "services/link/packet_filter/announcement.h"

#include <algorithm>
#include <cstring>

#include "services/link/packet_filter/submessage_check.h"

namespace giveway::link {
namespace {

constexpr std::array<std::uint8_t, 4> kAnnouncer = {0x00, 0x01, 0x00, 0xc2};
constexpr std::array<std::uint8_t, 4> kListener = {0x00, 0x01, 0x00, 0xc7};

constexpr std::uint16_t kLeaseDuration = 0x0002;  // ids of parameters
constexpr std::uint16_t kParticipantGuid = 0x0050;
constexpr std::uint16_t kEndpointGuid = 0x005a;
constexpr std::size_t kLeaseBytes = 8;
constexpr std::size_t kGuidBytes = 16;
constexpr std::uint8_t kKeyHash = 0x70;
constexpr std::uint8_t kStatusInfo = 0x71;
constexpr std::uint8_t kDisposedAndUnregistered = 3;

// In a list that was found sound: nowhere, or once and of that length.
bool StandsOnceAtMost(const Submessage& list, std::uint16_t id, std::size_t bytes) {
  const Bytes first = FindParameter(list, 0, id);
  if (first.data() == nullptr) return true;
  if (first.size() != bytes) return false;
  const auto behind = static_cast<std::size_t>(first.data() - list.body.data()) + Padded(bytes);
  return FindParameter(list, behind, id).data() == nullptr;
}

// Whether each parameter of that id in a sound list has the value that is wanted. `wanted`, where
// it is empty, becomes the first one's.
bool AllAre(const Submessage& list, std::uint16_t id, Bytes* wanted) {
  for (std::size_t from = 0;;) {
    const Bytes value = FindParameter(list, from, id);
    if (value.data() == nullptr) return true;
    if (value.size() != kGuidBytes) return false;
    if (wanted->empty()) *wanted = value;
    if (!std::ranges::equal(value, *wanted)) return false;
    from = static_cast<std::size_t>(value.data() - list.body.data()) + value.size();
  }
}

// Its lease, in the byte order of its list: seconds, and a fraction in units of 2^-32.
std::optional<Submessage> LeaseOf(const Submessage& announcement) {
  std::optional<Submessage> lease = ParametersOf(announcement);
  if (!lease) return std::nullopt;
  lease->body = FindParameter(*lease, 0, kLeaseDuration);
  return lease->body.size() < kLeaseBytes ? std::nullopt : lease;
}

bool NamesNoOtherEntity(const Submessage& list) {
  const Bytes guid = FindParameter(list, 0, kParticipantGuid);
  return guid.empty() || std::equal(kParticipantEntity.begin(), kParticipantEntity.end(),
                                    guid.begin() + std::tuple_size_v<PrefixBytes>);
}

// From there on; returns where it ends.
template <std::size_t size>
std::size_t Put(const std::array<std::uint8_t, size>& bytes, std::size_t at, Farewell* to) {
  std::copy_n(bytes.begin(), size, to->begin() + static_cast<std::ptrdiff_t>(at));
  return at + size;
}

std::optional<EndpointGuid> GuidIn(Bytes found) {
  EndpointGuid guid;
  if (found.size() != guid.size()) return std::nullopt;
  std::ranges::copy(found, guid.begin());
  return guid;
}

std::optional<EndpointGuid> NamedInPayload(const Submessage& of_endpoint) {
  const std::optional<Submessage> list = ParametersOf(of_endpoint);
  if (!list) return std::nullopt;
  const Bytes guid = FindParameter(*list, 0, kEndpointGuid);
  return GuidIn(guid.empty() ? FindParameter(*list, 0, kKeyHash) : guid);
}

// High word first, each in big-endian order.
std::array<std::uint8_t, 8> BigEndian(std::int64_t number) {
  std::array<std::uint8_t, 8> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> (56 - 8 * i));
  }
  return bytes;
}

}  // namespace

std::size_t PrefixHash::operator()(const PrefixBytes& prefix) const {
  std::uint64_t low;
  std::uint32_t high;
  std::memcpy(&low, prefix.data(), sizeof low);
  std::memcpy(&high, prefix.data() + sizeof low, sizeof high);
  return (low ^ high) * 0x9e37'79b9'7f4a'7c15U >> 16U;
}

PrefixBytes SenderOf(Bytes packet) {
  PrefixBytes sender;
  std::copy_n(packet.begin() + kSenderAt, sender.size(), sender.begin());
  return sender;
}

bool IsAnnouncement(const Submessage& submessage) {
  return submessage.kind == SubmessageKind::kData &&
         std::equal(kAnnouncer.begin(), kAnnouncer.end(), submessage.body.begin() + kWriterInData);
}

bool IsFarewell(const Submessage& announcement) {
  constexpr std::size_t kStatusBytes = 4;
  const Bytes status = FindInlineParameter(announcement, kStatusInfo);
  return status.size() == kStatusBytes && status[3] >= 1 && status[3] <= kDisposedAndUnregistered;
}

bool IsUnambiguous(const Submessage& announcement) {
  const std::optional<Submessage> list = ParametersOf(announcement);
  if (!list) return true;
  const bool no_hash = FindParameter(*list, 0, kKeyHash).data() == nullptr;
  return StandsOnceAtMost(*list, kParticipantGuid, kGuidBytes) && NamesNoOtherEntity(*list) &&
         StandsOnceAtMost(*list, kLeaseDuration, kLeaseBytes) &&
         (no_hash || !announcement.Has(kWithData));  // with a key it is a farewell
}

bool NamesOneEndpoint(const Submessage& of_endpoint) {
  const std::optional<Submessage> list = ParametersOf(of_endpoint);
  Bytes guid;
  return !list || (AllAre(*list, kEndpointGuid, &guid) && AllAre(*list, kKeyHash, &guid));
}

std::optional<EndpointGuid> AnnouncedEndpoint(const Submessage& of_endpoint) {
  return of_endpoint.Has(kWithData) ? NamedInPayload(of_endpoint) : std::nullopt;
}

// Fast DDS names it in the inline QoS, and sends no payload.
std::optional<EndpointGuid> EndedEndpoint(const Submessage& of_endpoint) {
  if (of_endpoint.Has(kWithData)) return std::nullopt;
  const auto inline_key = GuidIn(FindInlineParameter(of_endpoint, kKeyHash));
  return inline_key ? inline_key : NamedInPayload(of_endpoint);
}

std::optional<PrefixBytes> EndedParticipant(const Submessage& farewell) {
  const Bytes hash = FindInlineParameter(farewell, kKeyHash);
  if (hash.size() != kGuidBytes) return AnnouncedParticipant(farewell);
  PrefixBytes prefix;
  std::copy_n(hash.begin(), prefix.size(), prefix.begin());
  return prefix;
}

std::optional<PrefixBytes> AnnouncedParticipant(const Submessage& announcement) {
  const std::optional<Submessage> list = ParametersOf(announcement);
  const Bytes guid = list ? FindParameter(*list, 0, kParticipantGuid) : Bytes{};
  PrefixBytes prefix;
  if (guid.size() < prefix.size()) return std::nullopt;
  std::copy_n(guid.begin(), prefix.size(), prefix.begin());
  return prefix;
}

std::optional<Nanoseconds> AnnouncedLease(const Submessage& announcement) {
  const std::optional<Submessage> lease = LeaseOf(announcement);
  if (!lease) return std::nullopt;
  const std::uint64_t fraction_ns = (std::uint64_t{lease->U32(4)} * 1'000'000'000) >> 32U;
  return std::chrono::seconds(lease->U32(0)) + Nanoseconds(fraction_ns);
}

void ShortenLeases(std::span<std::uint8_t> packet, std::chrono::seconds most) {
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    if (!IsAnnouncement(part)) continue;
    const std::optional<Submessage> lease = LeaseOf(part);
    if (!lease || lease->U32(0) < most.count()) continue;
    auto seconds = static_cast<std::uint32_t>(most.count());
    if (!lease->IsLittleEndian()) seconds = __builtin_bswap32(seconds);
    std::uint8_t* const at = packet.data() + (lease->body.data() - packet.data());
    std::memcpy(at, &seconds, sizeof seconds);
    std::memset(at + sizeof seconds, 0, sizeof seconds);  // the fraction
  }
}

std::int64_t AnnouncementNumber(const Submessage& announcement) {
  return announcement.SequenceNumber(kNumberInData);
}

Farewell FarewellOf(const PrefixBytes& participant, std::int64_t number) {
  constexpr std::uint8_t kToInlineQos = kNumberInData + 8 - kReaderInData;
  Farewell packet;
  std::size_t at =
      Put(std::array<std::uint8_t, 8>{'R', 'T', 'P', 'S', 2, 3, 0x01, 0x0f}, 0, &packet);
  at = Put(participant, at, &packet);
  constexpr std::size_t kBodyAt = kRtpsHeaderBytes + kSubmessageHeaderBytes;
  constexpr std::uint8_t kBytes = std::tuple_size_v<Farewell> - kBodyAt;
  at = Put(std::to_array<std::uint8_t>(
               {static_cast<std::uint8_t>(SubmessageKind::kData), kInlineQos, 0, kBytes}),
           at, &packet);
  at = Put(std::to_array<std::uint8_t>({0, 0, 0, kToInlineQos}), at, &packet);
  at = Put(kListener, at, &packet);
  at = Put(kAnnouncer, at, &packet);
  at = Put(BigEndian(number), at, &packet);
  at = Put(std::to_array<std::uint8_t>({0, kKeyHash, 0, 16}), at, &packet);
  at = Put(participant, at, &packet);
  at = Put(kParticipantEntity, at, &packet);
  at = Put(std::to_array<std::uint8_t>({0, kStatusInfo, 0, 4, 0, 0, 0, kDisposedAndUnregistered}),
           at, &packet);
  Put(std::to_array<std::uint8_t>({0, std::uint8_t{kSentinel}, 0, 0}), at, &packet);
  return packet;
}

}  // namespace giveway::link
