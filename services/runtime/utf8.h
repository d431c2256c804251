// UTF-8 as far as the texts of logs and reports need it (RFC 3629), on utfcpp.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace giveway {

// True if `text` is well-formed and without NUL bytes.
bool IsText(std::string_view text);
// The text with every byte that belongs to no sequence replaced by U+FFFD.
std::string WellFormed(std::string_view text);
// Text from a file or from the wire, without control sequences for the terminal that shows it:
// well-formed, and each control character a question mark.
std::string Printable(std::string_view text);
// At most `most` bytes of the text and, if that is not all, an ellipsis.
std::string Shortened(std::string_view text, std::size_t most);

}  // namespace giveway
