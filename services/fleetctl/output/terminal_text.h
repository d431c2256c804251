// Text for a terminal: verdicts in colour, and the progress line of long work. The first part is
// pure; functions that query the terminal say so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace giveway::fleetctl {

// Colours the first verdict of each line (passed, failed, error, warning, ...) by ECMA-48: green,
// red or yellow. Everything else is unchanged.
std::string InColour(std::string_view text);

// Lines of at most `columns` characters, broken at spaces; continuation lines are indented by four
// more than their line. A longer word is not broken.
std::string Folded(std::string_view text, std::size_t columns);

// "about 90 s left", "about 12 min left", at the pace so far; "no estimate yet" before the first.
std::string TimeLeft(std::uint64_t done, std::uint64_t all, double gone_s);

// A bar before `text`, together at most `columns` - 1, so that the cursor stays in the line.
std::string ProgressLine(std::uint64_t done, std::uint64_t all, const std::string& text,
                         std::size_t columns);

// Queries the terminal: if stdout is one, `text` is folded to its width, and coloured unless
// NO_COLOR or TERM forbid it.
std::string ForTerminal(const std::string& text);
// Folded alone: for lists and tables without a verdict.
std::string FoldedForTerminal(const std::string& text);
// Of stderr; 80 if it is not a terminal.
std::size_t StderrColumns();

}  // namespace giveway::fleetctl
