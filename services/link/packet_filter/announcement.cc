#include "services/link/packet_filter/announcement.h"

#include <algorithm>

#include "services/link/packet_filter/submessage_check.h"

namespace giveway::link {
namespace {

constexpr std::size_t kAnnouncementReaderAt = 4;  // of DATA: entity ids, and the number
constexpr std::size_t kAnnouncerAt = 8;
constexpr std::size_t kAnnouncementNumberAt = 12;
constexpr std::array<std::uint8_t, 4> kAnnouncer = {0x00, 0x01, 0x00, 0xc2};
constexpr std::array<std::uint8_t, 4> kListener = {0x00, 0x01, 0x00, 0xc7};
constexpr std::array<std::uint8_t, 4> kParticipantEntity = {0x00, 0x00, 0x01, 0xc1};

constexpr std::uint16_t kLeaseDuration = 0x0002;  // ids of parameters
constexpr std::uint16_t kParticipantGuid = 0x0050;
constexpr std::uint8_t kKeyHash = 0x70;
constexpr std::uint8_t kStatusInfo = 0x71;
constexpr std::uint8_t kDisposedAndUnregistered = 3;
constexpr std::uint8_t kEndOfList = 0x01;
constexpr std::size_t kEncapsulationBytes = 4;

constexpr std::uint8_t kInlineQosFlag = 0x02;
constexpr std::uint8_t kDataFlag = 0x04;

// Parameters are in the byte order that the payload's encapsulation names.
Submessage ParametersOf(const Submessage& announcement) {
  const Bytes payload = announcement.body.subspan(PayloadOfData(announcement));
  if (!announcement.Has(kDataFlag) || payload.size() < kEncapsulationBytes) return {};
  Submessage list;
  list.flags = payload[1] & 1U;
  list.body = payload.subspan(kEncapsulationBytes);
  return list;
}

template <std::size_t size>
void Append(const std::array<std::uint8_t, size>& bytes, std::vector<std::uint8_t>* to) {
  to->insert(to->end(), bytes.begin(), bytes.end());
}

// High word first, each in big-endian order.
void AppendNumber(std::int64_t number, std::vector<std::uint8_t>* to) {
  for (int shift = 56; shift >= 0; shift -= 8) {
    to->push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> shift));
  }
}

}  // namespace

bool IsAnnouncement(const Submessage& submessage) {
  return submessage.kind == SubmessageKind::kData &&
         std::equal(kAnnouncer.begin(), kAnnouncer.end(), submessage.body.begin() + kAnnouncerAt);
}

std::optional<PrefixBytes> AnnouncedParticipant(const Submessage& announcement) {
  const Bytes guid = FindParameter(ParametersOf(announcement), 0, kParticipantGuid);
  PrefixBytes prefix;
  if (guid.size() < prefix.size()) return std::nullopt;
  std::copy_n(guid.begin(), prefix.size(), prefix.begin());
  return prefix;
}

std::optional<Nanoseconds> AnnouncedLease(const Submessage& announcement) {
  Submessage list = ParametersOf(announcement);
  list.body = FindParameter(list, 0, kLeaseDuration);
  if (list.body.size() < 8) return std::nullopt;
  const std::uint64_t fraction_ns = (std::uint64_t{list.U32(4)} * 1'000'000'000) >> 32U;
  return std::chrono::seconds(list.U32(0)) + Nanoseconds(fraction_ns);
}

std::int64_t AnnouncementNumber(const Submessage& announcement) {
  return announcement.SequenceNumber(kAnnouncementNumberAt);
}

std::vector<std::uint8_t> FarewellOf(const PrefixBytes& participant, std::int64_t number) {
  std::vector<std::uint8_t> body = {
      0, 0, 0, kAnnouncementNumberAt + 8 - kAnnouncementReaderAt};  // to the inline QoS
  Append(kListener, &body);
  Append(kAnnouncer, &body);
  AppendNumber(number, &body);
  body.insert(body.end(), {0, kKeyHash, 0, 16});
  Append(participant, &body);
  Append(kParticipantEntity, &body);
  body.insert(body.end(), {0, kStatusInfo, 0, 4, 0, 0, 0, kDisposedAndUnregistered});
  body.insert(body.end(), {0, kEndOfList, 0, 0});

  std::vector<std::uint8_t> packet = {'R', 'T', 'P', 'S', 2, 3, 0x01, 0x0f};
  Append(participant, &packet);
  packet.insert(packet.end(), {static_cast<std::uint8_t>(SubmessageKind::kData), kInlineQosFlag, 0,
                               static_cast<std::uint8_t>(body.size())});
  packet.insert(packet.end(), body.begin(), body.end());
  return packet;
}

}  // namespace giveway::link
