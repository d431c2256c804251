// Writes RTPS packets byte by byte: valid ones as Fast DDS sends them, and any others.
// Little-endian unless a test asks for the other order. Formats: OMG RTPS 2.3, 9.4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace giveway::test {

using PacketBytes = std::vector<std::uint8_t>;
using PrefixBytes = std::array<std::uint8_t, 12>;

inline constexpr std::array<std::uint8_t, 2> kEProsima = {0x01, 0x0f};
inline constexpr std::array<std::uint8_t, 2> kCyclone = {0x01, 0x10};
// Entity ids, as a big-endian number.
inline constexpr std::uint32_t kAnyReader = 0;
inline constexpr std::uint32_t kUserWriter = 0x00000103;
inline constexpr std::uint32_t kAnnouncer = 0x000100c2;
inline constexpr std::uint32_t kPublications = 0x000003c2;

class RtpsPacket {
 public:
  explicit RtpsPacket(const PrefixBytes& prefix,
                      const std::array<std::uint8_t, 2>& vendor = kEProsima, bool little = true)
      : little_(little) {
    bytes_ = {'R', 'T', 'P', 'S', 2, 3, vendor[0], vendor[1]};
    bytes_.insert(bytes_.end(), prefix.begin(), prefix.end());
  }

  // A submessage by itself. Without a length the body's own is stated.
  RtpsPacket& Add(std::uint8_t kind, std::uint8_t flags, std::span<const std::uint8_t> body,
                  int stated_length = -1) {
    bytes_.push_back(kind);
    bytes_.push_back(static_cast<std::uint8_t>(flags | (little_ ? 1U : 0U)));
    const int stated = stated_length < 0 ? static_cast<int>(body.size()) : stated_length;
    Append(static_cast<std::uint64_t>(stated), 2, &bytes_);
    bytes_.insert(bytes_.end(), body.begin(), body.end());
    return *this;
  }
  RtpsPacket& InfoTs() { return Add(0x09, 0, PacketBytes(8)); }
  RtpsPacket& InfoDst(const PrefixBytes& to) { return Add(0x0e, 0, to); }
  RtpsPacket& Data(std::uint32_t writer, std::int64_t number, std::span<const std::uint8_t> payload,
                   std::uint32_t reader = kAnyReader) {
    PacketBytes body;
    Append(0, 2, &body);
    Append(16, 2, &body);
    AppendEntity(reader, &body);
    AppendEntity(writer, &body);
    AppendNumber(number, &body);
    body.insert(body.end(), payload.begin(), payload.end());
    return Add(0x15, 0x04, body);
  }
  RtpsPacket& DataFrag(std::uint32_t writer, std::int64_t number, std::uint32_t first,
                       std::uint16_t count, std::uint16_t fragment_bytes,
                       std::uint32_t sample_bytes, std::size_t payload_bytes,
                       std::uint32_t reader = kAnyReader) {
    PacketBytes body;
    Append(0, 2, &body);
    Append(28, 2, &body);
    AppendEntity(reader, &body);
    AppendEntity(writer, &body);
    AppendNumber(number, &body);
    Append(first, 4, &body);
    Append(count, 2, &body);
    Append(fragment_bytes, 2, &body);
    Append(sample_bytes, 4, &body);
    body.resize(body.size() + payload_bytes);
    return Add(0x16, 0, body);
  }
  RtpsPacket& Heartbeat(std::uint32_t writer, std::int64_t first, std::int64_t last,
                        std::uint32_t count, std::uint32_t reader = kAnyReader) {
    PacketBytes body;
    AppendEntity(reader, &body);
    AppendEntity(writer, &body);
    AppendNumber(first, &body);
    AppendNumber(last, &body);
    Append(count, 4, &body);
    return Add(0x07, 0, body);
  }
  RtpsPacket& Gap(std::uint32_t writer, std::int64_t start, std::int64_t base,
                  std::uint32_t bits = 0, std::uint32_t reader = kAnyReader) {
    PacketBytes body;
    AppendEntity(reader, &body);
    AppendEntity(writer, &body);
    AppendNumber(start, &body);
    AppendNumber(base, &body);
    Append(bits, 4, &body);
    body.resize(body.size() + 4 * (bits / 32 + (bits % 32 == 0 ? 0 : 1)));
    return Add(0x08, 0, body);
  }
  RtpsPacket& AckNack(std::uint32_t writer, std::int64_t base, std::uint32_t bits,
                      std::size_t words, std::uint32_t count = 1,
                      std::uint32_t reader = kAnyReader) {
    PacketBytes body;
    AppendEntity(reader, &body);
    AppendEntity(writer, &body);
    AppendNumber(base, &body);
    Append(bits, 4, &body);
    body.resize(body.size() + 4 * words);
    Append(count, 4, &body);
    return Add(0x06, 0, body);
  }
  RtpsPacket& NackFrag(std::uint32_t writer, std::int64_t number, std::uint32_t first,
                       std::uint32_t bits, std::uint32_t count = 1,
                       std::uint32_t reader = kAnyReader) {
    PacketBytes body;
    AppendEntity(reader, &body);
    AppendEntity(writer, &body);
    AppendNumber(number, &body);
    Append(first, 4, &body);
    Append(bits, 4, &body);
    body.resize(body.size() + 4 * (bits / 32 + (bits % 32 == 0 ? 0 : 1)), 0xff);
    Append(count, 4, &body);
    return Add(0x12, 0, body);
  }
  // As Fast DDS ends each packet it sends; always big-endian.
  RtpsPacket& Statistics() {
    bytes_.insert(bytes_.end(), {0x80, 0, 0, 56});
    bytes_.resize(bytes_.size() + 56);
    return *this;
  }
  // The announcement of a participant of this prefix, with so many seconds of lease, and with more
  // parameters at its end.
  RtpsPacket& Announcement(const PrefixBytes& participant, std::int64_t number,
                           std::uint32_t lease_s = 20,
                           std::span<const std::uint8_t> more_parameters = {}) {
    PacketBytes payload = {0, static_cast<std::uint8_t>(little_ ? 3 : 2), 0, 0};
    const auto parameter = [&](std::uint16_t id, const PacketBytes& value) {
      Append(id, 2, &payload);
      Append(value.size(), 2, &payload);
      payload.insert(payload.end(), value.begin(), value.end());
    };
    parameter(0x0015, {2, 3, 0, 0});                        // protocol version
    parameter(0x0016, {kEProsima[0], kEProsima[1], 0, 0});  // vendor
    PacketBytes guid(participant.begin(), participant.end());
    AppendEntity(0x000001c1, &guid);
    parameter(0x0050, guid);
    PacketBytes lease;
    Append(lease_s, 4, &lease);
    Append(0, 4, &lease);
    parameter(0x0002, lease);
    PacketBytes endpoints;
    Append(0x0000'0c3f, 4, &endpoints);
    parameter(0x0058, endpoints);
    for (const std::uint16_t id : {std::uint16_t{0x0031}, std::uint16_t{0x0032}}) {
      PacketBytes locator;  // unicast addresses where nothing listens: 127.0.0.1:9
      Append(1, 4, &locator);
      Append(9, 4, &locator);
      locator.resize(locator.size() + 12);
      locator.insert(locator.end(), {127, 0, 0, 1});
      parameter(id, locator);
    }
    payload.insert(payload.end(), more_parameters.begin(), more_parameters.end());
    parameter(1, {});
    return Data(kAnnouncer, number, payload, 0x000100c7);
  }

  // The announcement of a writer of a participant, with more parameters at its end.
  RtpsPacket& WriterAnnouncement(const PrefixBytes& participant, std::uint32_t writer,
                                 std::int64_t number,
                                 std::span<const std::uint8_t> more_parameters = {}) {
    PacketBytes payload = {0, static_cast<std::uint8_t>(little_ ? 3 : 2), 0, 0};
    Append(0x005a, 2, &payload);
    Append(16, 2, &payload);
    payload.insert(payload.end(), participant.begin(), participant.end());
    AppendEntity(writer, &payload);
    payload.insert(payload.end(), more_parameters.begin(), more_parameters.end());
    Append(1, 2, &payload);
    Append(0, 2, &payload);
    return Data(kPublications, number, payload, 0x000003c7);
  }

  // Its end, as Fast DDS announces it: the key in the inline QoS, and no payload.
  RtpsPacket& WriterEnd(const PrefixBytes& participant, std::uint32_t writer, std::int64_t number) {
    PacketBytes body;
    Append(0, 2, &body);
    Append(16, 2, &body);
    AppendEntity(0x000003c7, &body);
    AppendEntity(kPublications, &body);
    AppendNumber(number, &body);
    Append(0x0070, 2, &body);
    Append(16, 2, &body);
    body.insert(body.end(), participant.begin(), participant.end());
    AppendEntity(writer, &body);
    Append(0x0071, 2, &body);
    Append(4, 2, &body);
    body.insert(body.end(), {0, 0, 0, 3});
    Append(1, 2, &body);
    Append(0, 2, &body);
    return Add(0x15, 0x02, body);
  }

  const PacketBytes& Bytes() const { return bytes_; }

 private:
  void Append(std::uint64_t word, std::size_t size, PacketBytes* to) const {
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = little_ ? i : size - 1 - i;
      to->push_back(static_cast<std::uint8_t>(word >> (8 * place)));
    }
  }
  static void AppendEntity(std::uint32_t entity, PacketBytes* to) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      to->push_back(static_cast<std::uint8_t>(entity >> static_cast<unsigned>(shift)));
    }
  }
  // The high half stands first in either byte order.
  void AppendNumber(std::int64_t number, PacketBytes* to) const {
    const auto bits = static_cast<std::uint64_t>(number);
    Append(bits >> 32U, 4, to);
    Append(bits & 0xffff'ffffU, 4, to);
  }

  PacketBytes bytes_;
  bool little_;
};

}  // namespace giveway::test
