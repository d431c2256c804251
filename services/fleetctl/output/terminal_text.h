// Text for a terminal: verdicts in colour, and the line that shows how far long work is. The first
// part is pure; what asks the terminal says so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace giveway::fleetctl {

// The first verdict of each line (passed, failed, error, warning, ...) as an ECMA-48 colour: green,
// red or yellow. Everything else is as it was.
std::string InColour(std::string_view text);

// Lines of at most `columns` characters, broken at spaces; what follows a break is indented by four
// more than its line. A word that is longer stays whole.
std::string Folded(std::string_view text, std::size_t columns);

// "about 90 s left", "about 12 min left", at the pace so far; "no estimate yet" before the first.
std::string TimeLeft(std::uint64_t done, std::uint64_t all, double gone_s);

// A bar in front of `text`, together at most `columns` - 1, so that the cursor stays in the line.
std::string ProgressLine(std::uint64_t done, std::uint64_t all, const std::string& text,
                         std::size_t columns);

// Asks the terminal: where stdout is one, `text` is folded to its width, and in colour unless
// NO_COLOR or TERM forbid it.
std::string ForTerminal(const std::string& text);
// Of stderr; 80 where it is no terminal.
std::size_t StderrColumns();

}  // namespace giveway::fleetctl
