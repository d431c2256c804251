#include "services/link/packet_filter/discovery_list.h"

#include <algorithm>
#include <optional>

#include "services/link/packet_filter/announcement.h"
#include "services/link/packet_filter/submessage_check.h"

namespace giveway::link {
namespace {

std::uint32_t EntityAt(const Submessage& of, std::size_t at) {
  return std::uint32_t{of.body[at]} << 24U | std::uint32_t{of.body[at + 1]} << 16U |
         std::uint32_t{of.body[at + 2]} << 8U | of.body[at + 3];
}

// By either end: the library hands a payload to the reader that it names, and to that of its
// writer.
bool HasDiscoveryEnd(const Submessage& data) {
  const std::uint32_t writer = EntityAt(data, kWriterInData);
  const std::uint32_t reader = EntityAt(data, kReaderInData);
  return writer == 0x000100c2 || writer == 0x000003c2 || writer == 0x000004c2 ||
         reader == 0x000100c7 || reader == 0x000003c7 || reader == 0x000004c7;
}

// Steps through the value of a parameter; false where it ends before what it states.
class ValueWalk {
 public:
  explicit ValueWalk(const Submessage& value) : value_(value) {}

  bool Number(std::uint32_t* to) {
    if (value_.body.size() - at_ < 4) return false;
    *to = value_.U32(at_);
    at_ += 4;
    return true;
  }
  bool Sequence(std::size_t bytes_each) {
    std::uint32_t count = 0;
    if (!Number(&count)) return false;
    const std::uint64_t bytes = std::uint64_t{count} * bytes_each;
    if (bytes > value_.body.size() - at_) return false;
    at_ = std::min(value_.body.size(), Padded(at_ + bytes));
    return true;
  }
  // The library reads partitions up to their NUL, wherever that is.
  bool StringWithEnd() {
    const std::size_t first = at_ + 4;
    std::uint32_t bytes = 0;
    if (!ValueWalk(*this).Number(&bytes) || !Sequence(1)) return false;
    return bytes > 0 && value_.body[first + bytes - 1] == 0;
  }
  bool Strings(std::uint32_t most) {
    std::uint32_t count = 0;
    if (!Number(&count) || count > most) return false;
    for (; count > 0; --count) {
      if (!StringWithEnd()) return false;
    }
    return true;
  }
  // Of names and values, each a sequence of octets.
  bool Properties() {
    std::uint32_t count = 0;
    if (!Number(&count)) return false;
    for (; count > 0; --count) {
      if (!Sequence(1) || !Sequence(1)) return false;
    }
    return true;
  }
  // Class, properties, binary properties.
  bool Token() { return Sequence(1) && Properties() && Properties(); }

 private:
  const Submessage& value_;
  std::size_t at_ = 0;
};

PacketDrop CheckParameter(std::uint16_t id, const Submessage& value, bool secured) {
  ValueWalk walk(value);
  bool fits = true;
  switch (id) {
    case 0x0005:  // names of topic, type and entity
    case 0x0007:
    case 0x0062:
    case 0x002c:  // data of user, group and topic
    case 0x002d:
    case 0x002e:
      fits = walk.Sequence(1);
      break;
    case 0x0029:  // partitions
      fits = walk.Strings(kMostPartitions);
      break;
    case 0x0059:
      fits = walk.Properties();
      break;
    case 0x0073:  // data representations
      fits = walk.Sequence(2);
      break;
    case 0x8006:  // domains of data sharing
      fits = walk.Sequence(8);
      break;
    case 0x1001:  // tokens of identity and permissions: read whether or not security is on
    case 0x1002:
      if (!secured) return PacketDrop::kMalformed;
      fits = walk.Token();
      break;
    default:
      break;
  }
  return fits ? PacketDrop::kNone : PacketDrop::kListTooLong;
}

bool DescribesType(std::uint16_t id) {
  return id == 0x0069 || id == 0x0072 || id == 0x0075;  // identifier, object, information
}

// In the byte order of `list`, which starts with the first parameter.
PacketDrop CheckList(const Submessage& list, bool secured) {
  Submessage value;
  value.flags = list.flags;
  std::size_t listed = 0;
  std::size_t described = 0;
  for (std::size_t at = 0; at + kParameterHeader <= list.body.size();) {
    const std::uint16_t id = list.U16(at);
    const std::size_t length = list.U16(at + 2);
    at += kParameterHeader;
    if (id == kSentinel) return PacketDrop::kNone;
    if (Padded(length) > list.body.size() - at) return PacketDrop::kListTooLong;
    value.body = list.body.subspan(at, length);
    const PacketDrop drop = CheckParameter(id, value, secured);
    if (drop != PacketDrop::kNone) return drop;
    (DescribesType(id) ? described : listed) += kParameterHeader + Padded(length);
    if (listed > kMostListed || described > kMostDescribed) return PacketDrop::kListTooLong;
    at += Padded(length);
  }
  return PacketDrop::kListTooLong;
}

// `packet` holds the list.
void HideTypesOf(const Submessage& list, std::span<std::uint8_t> packet) {
  const auto first = static_cast<std::size_t>(list.body.data() - packet.data());
  for (std::size_t at = 0; at + kParameterHeader <= list.body.size();) {
    const std::uint16_t id = list.U16(at);
    if (id == kSentinel) return;
    if (DescribesType(id)) packet[first + at] = packet[first + at + 1] = 0;  // of padding
    at += kParameterHeader + Padded(list.U16(at + 2));
  }
}

}  // namespace

bool IsOfDiscovery(const Submessage& submessage) {
  const bool is_data =
      submessage.kind == SubmessageKind::kData || submessage.kind == SubmessageKind::kDataFrag;
  return is_data && HasDiscoveryEnd(submessage);
}

PacketDrop CheckDiscovery(const Submessage& of_discovery, bool secured) {
  // Only whole can it be judged, and each of Fast DDS fits into a datagram.
  if (of_discovery.kind == SubmessageKind::kDataFrag) return PacketDrop::kFragmentedAnnouncement;
  const std::optional<Submessage> list = ParametersOf(of_discovery);
  const PacketDrop drop = list ? CheckList(*list, secured) : PacketDrop::kNone;
  if (drop != PacketDrop::kNone) return drop;
  const bool unambiguous =
      IsAnnouncement(of_discovery) ? IsUnambiguous(of_discovery) : NamesOneEndpoint(of_discovery);
  return unambiguous ? PacketDrop::kNone : PacketDrop::kMalformed;
}

void HideTypes(std::span<std::uint8_t> packet) {
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    if (!IsOfDiscovery(part)) continue;
    const std::optional<Submessage> list = ParametersOf(part);
    if (list) HideTypesOf(*list, packet);
  }
}

}  // namespace giveway::link
