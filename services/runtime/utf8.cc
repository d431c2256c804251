#include "services/runtime/utf8.h"

#include <utf8.h>

namespace giveway {

bool IsText(std::string_view text) {
  return utf8::is_valid(text.begin(), text.end()) && text.find('\0') == std::string_view::npos;
}

std::string WellFormed(std::string_view text) {
  std::string well_formed;
  for (auto rest = text.begin();;) {
    const auto broken = utf8::find_invalid(rest, text.end());
    well_formed.append(rest, broken);
    if (broken == text.end()) return well_formed;
    well_formed += "\xef\xbf\xbd";
    rest = broken + 1;
  }
}

std::string Printable(std::string_view text) {
  std::string printable;
  for (const std::string well_formed = WellFormed(text); const char c : well_formed) {
    const auto byte = static_cast<unsigned char>(c);
    // C2 80 to C2 9F are U+0080 to U+009F: of them U+009B starts a sequence as ESC [ does.
    const bool second = !printable.empty() && printable.back() == '\xc2' && byte < 0xa0;
    if (second) printable.pop_back();
    printable += second || byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  return printable;
}

std::string Shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0U) == 0x80) --most;
  return std::string(text.substr(0, most)) + "\xe2\x80\xa6";
}

}  // namespace giveway
