// Holds a profile file against the tables of schema.h: unknown elements, values of the wrong kind,
// elements given twice or empty, and what the library accepts without effect.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "services/qos/finding.h"
#include "services/qos/xml_tree.h"

namespace giveway::qos {

void CheckSchema(const XmlElement& root, const std::string& file, Findings* findings);

// What a value written in an element means; nothing if it means nothing.
std::optional<std::int64_t> ParseNumber(std::string_view text);
// Nanoseconds, or kInfinite.
std::optional<std::int64_t> ParseDuration(const XmlElement& element);
std::optional<bool> ParseFlag(std::string_view text);

}  // namespace giveway::qos
