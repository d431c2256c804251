// The bytes of an RTPS packet: numbers in either byte order, and the walk from one submessage to
// the next, just as Fast DDS takes it. Reads nothing beyond the packet. Formats: OMG RTPS 2.3, 9.4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace giveway::link {

using Bytes = std::span<const std::uint8_t>;
using PrefixBytes = std::array<std::uint8_t, 12>;  // of a participant's GUID

inline constexpr std::size_t kRtpsHeaderBytes = 20;
inline constexpr std::size_t kSenderAt = 8;  // in the header: the prefix of the sender
inline constexpr std::size_t kSubmessageHeaderBytes = 4;
inline constexpr std::size_t kEncapsulation = 4;  // bytes, in front of a payload

// Of a DATA, and of a DATA_FRAG as far as it goes: where in the body entity ids and the sequence
// number stand, and flags.
inline constexpr std::size_t kReaderInData = 4;
inline constexpr std::size_t kWriterInData = 8;
inline constexpr std::size_t kNumberInData = 12;
inline constexpr std::uint8_t kInlineQos = 0x02;
inline constexpr std::uint8_t kWithData = 0x04;  // of DATA alone
inline constexpr std::uint8_t kWithKey = 0x08;   // of DATA alone

inline constexpr std::size_t kWriterAt = 4;  // of HEARTBEAT, GAP, ACKNACK and NACK_FRAG
inline constexpr std::size_t kCountInHeartbeat = 24;

// A list of parameters: each has a header of id and length, and starts at a multiple of 4.
inline constexpr std::size_t kParameterHeader = 4;  // bytes
inline constexpr std::uint16_t kSentinel = 0x0001;  // the id that ends it
inline std::size_t Padded(std::size_t bytes) { return (bytes + 3) & ~std::size_t{3}; }

enum class SubmessageKind : std::uint8_t {
  kPad = 0x01,
  kAckNack = 0x06,
  kHeartbeat = 0x07,
  kGap = 0x08,
  kInfoTs = 0x09,
  kInfoSrc = 0x0c,
  kInfoReplyIp4 = 0x0d,
  kInfoDst = 0x0e,
  kInfoReply = 0x0f,
  kNackFrag = 0x12,
  kHeartbeatFrag = 0x13,
  kData = 0x15,
  kDataFrag = 0x16,
  kSecureFirst = 0x30,  // of DDS-Security: body, prefix and postfix of submessages and packets
  kSecureLast = 0x34,
  kVendorFirst = 0x80  // from here on each vendor's own
};

struct Submessage {
  SubmessageKind kind{};
  std::uint8_t flags = 0;
  std::uint16_t stated_length = 0;  // 0: to the end of the packet, unless kPad or kInfoTs
  Bytes body;

  bool Has(std::uint8_t flag) const { return (flags & flag) != 0; }
  bool IsLittleEndian() const { return Has(1); }

  std::uint16_t U16(std::size_t at) const {
    std::uint16_t word;
    std::memcpy(&word, body.data() + at, sizeof word);
    return IsLittleEndian() ? word : __builtin_bswap16(word);
  }
  std::uint32_t U32(std::size_t at) const {
    std::uint32_t word;
    std::memcpy(&word, body.data() + at, sizeof word);
    return IsLittleEndian() ? word : __builtin_bswap32(word);
  }
  // The high half stands first in either byte order.
  std::int64_t SequenceNumber(std::size_t at) const {
    return static_cast<std::int64_t>(std::uint64_t{U32(at)} << 32U | U32(at + 4));
  }
};

// Takes one submessage after the other off a packet.
class SubmessageWalk {
 public:
  explicit SubmessageWalk(Bytes packet) : packet_(packet) {}

  // False at the end, and where a submessage ends beyond the packet: then IsBroken.
  bool Next(Submessage* to) {
    start_ = next_;
    if (start_ >= packet_.size()) return false;
    const Bytes rest = packet_.subspan(start_);
    broken_ = rest.size() < kSubmessageHeaderBytes;
    if (broken_) return false;
    to->kind = static_cast<SubmessageKind>(rest[0]);
    to->flags = rest[1];
    to->body = rest.subspan(2);
    to->stated_length = to->U16(0);
    to->body = rest.subspan(kSubmessageHeaderBytes);
    broken_ = to->stated_length > to->body.size();
    if (broken_) return false;
    const bool to_the_end = to->stated_length == 0 && to->kind != SubmessageKind::kPad &&
                            to->kind != SubmessageKind::kInfoTs;
    if (!to_the_end) to->body = to->body.first(to->stated_length);
    next_ = start_ + kSubmessageHeaderBytes + ((to->body.size() + 3) & ~std::size_t{3});
    return true;
  }
  bool IsBroken() const { return broken_; }
  // Where the submessage starts that Next took last.
  std::size_t Start() const { return start_; }
  // Whether it is the last one.
  bool IsAtEnd() const { return next_ >= packet_.size(); }

 private:
  Bytes packet_;
  std::size_t start_ = 0;
  std::size_t next_ = kRtpsHeaderBytes;
  bool broken_ = false;
};

}  // namespace giveway::link
