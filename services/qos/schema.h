// Which elements a profile file may hold, as tables: name, content, what is inside. They are those
// of Fast DDS 2.9 in its spelling. With 3.1 the link respells what was renamed, so that one file
// serves a fleet of both.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace giveway::qos {

enum class Content : std::uint8_t {
  kElements,
  kWord,      // one of ElementRule::words
  kDuration,  // <sec> and <nanosec>, or a name for infinite
  kUnsigned,  // 32 bits; -1 is the largest
  kPort,      // 16 bits without a sign
  kInteger,   // 32 bits with a sign
  kByte,      // 0 to 255
  kFlag,      // true or false
  kText,
  kNoEffect,  // the library accepts whatever is inside, and does nothing
  kOpaque,    // beyond QoS; not looked into
  kDoor,      // beyond QoS too, and makes the library open files or load what QoS does not need
};

struct ElementRule {
  std::string_view name;
  Content content;
  std::span<const ElementRule> children{};
  std::string_view words{};
  bool repeats = false;    // may stand more than once
  bool must_hold = false;  // empty, it makes the library refuse the file
  bool gone_in_3 = false;  // Fast DDS 3 refuses the file for it
};

std::span<const ElementRule> EndpointElements(bool writer);
std::span<const ElementRule> TopicElements();
std::span<const ElementRule> ParticipantElements();
// By the type it names; that of UDP for none that is known.
std::span<const ElementRule> TransportElements(std::string_view type);

}  // namespace giveway::qos
