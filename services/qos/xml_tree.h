// XML bytes as a tree of values, each with its line. Knows nothing of QoS.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/qos/finding.h"

namespace giveway::qos {

// What services/link reads at most; a profile set has some 40 kB and 1200 elements.
inline constexpr std::size_t kMaxFileBytes = 8U << 20U;
inline constexpr std::size_t kMaxElements = 20'000;

struct XmlAttribute {
  std::string name;
  std::string value;
};

struct XmlElement {
  std::string name;
  std::string text;  // directly inside, as written; empty if there is none
  int line = 0;      // from 1
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;

  // The last child of that name, as the library's later elements win; null if there is none.
  const XmlElement* Child(std::string_view child_name) const;
  // The first one; null if there is none.
  const XmlElement* FirstChild(std::string_view child_name) const;
  // Child by child along "a/b/c".
  const XmlElement* Descendant(std::string_view path) const;
  // Empty if there is no such attribute.
  std::string Attribute(std::string_view attribute_name) const;
};

// The root, or a finding that says why there is none.
struct XmlRead {
  std::optional<XmlElement> root;
  Findings findings;
};

XmlRead ReadXml(std::string_view bytes, const std::string& file);

}  // namespace giveway::qos
