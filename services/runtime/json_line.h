// One log line as a JSON object. Report objects are printed by protobuf, not here.
#pragma once

#include <string>
#include <string_view>

namespace giveway {

// `text` as a JSON string with its quotes. Bytes that are not UTF-8 become U+FFFD.
std::string JsonString(std::string_view text);

}  // namespace giveway
