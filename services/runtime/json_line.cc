#include "services/runtime/json_line.h"

#include <fmt/format.h>

#include "services/runtime/utf8.h"

namespace giveway {
namespace {

std::string Escaped(char c) {
  switch (c) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    default:
      return fmt::format("\\u{:04x}", static_cast<unsigned>(c));
  }
}

}  // namespace

std::string JsonString(std::string_view text) {
  std::string json = "\"";
  for (const char c : WellFormed(text)) {
    const bool control = static_cast<unsigned char>(c) < 0x20;
    json += control || c == '"' || c == '\\' ? Escaped(c) : std::string(1, c);
  }
  return json + "\"";
}

}  // namespace giveway
