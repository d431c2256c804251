#include "services/fleetctl/output/terminal_text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

#include "services/runtime/terminal_size.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kGreen = "\x1b[32m";
constexpr const char* kRed = "\x1b[31m";
constexpr const char* kYellow = "\x1b[33m";
constexpr const char* kPlain = "\x1b[0m";

struct Verdict {
  std::string_view word;
  const char* colour;
};

// Legible on a light and on a dark background.
constexpr std::array kVerdicts = {
    Verdict{"passed", kGreen},      Verdict{"It fits.", kGreen},
    Verdict{"Verified", kGreen},    Verdict{"failed", kRed},
    Verdict{"PASSED", kGreen},      Verdict{"FAILED", kRed},
    Verdict{"NOT RUN", kRed},       Verdict{"not_run", kRed},
    Verdict{"error", kRed},         Verdict{"It does not fit.", kRed},
    Verdict{"does not hear", kRed}, Verdict{"interrupted", kYellow},
    Verdict{"warning", kYellow},    Verdict{"rolled back", kYellow},
};

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

// "failed 0" is a count, not a verdict.
bool IsCount(std::string_view line, std::size_t end) {
  return end + 1 < line.size() && line[end] == ' ' && line[end + 1] >= '0' && line[end + 1] <= '9';
}

// Where it is a separate word; npos if it is none.
std::size_t FindWord(std::string_view line, std::string_view word) {
  for (std::size_t at = line.find(word); at != std::string_view::npos;
       at = line.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !IsLetter(line[at - 1]);
    if (begins && (end == line.size() || (!IsLetter(line[end]) && !IsCount(line, end)))) return at;
  }
  return std::string_view::npos;
}

std::string LineInColour(std::string_view line) {
  const Verdict* first = nullptr;
  std::size_t first_at = std::string_view::npos;
  for (const Verdict& verdict : kVerdicts) {
    const std::size_t at = FindWord(line, verdict.word);
    if (at < first_at) {
      first = &verdict;
      first_at = at;
    }
  }
  if (first == nullptr) return std::string(line);
  return fmt::format("{}{}{}{}{}", line.substr(0, first_at), first->colour, first->word, kPlain,
                     line.substr(first_at + first->word.size()));
}

// In characters, not bytes.
std::size_t Width(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

// Where to break so that at most `columns` characters stay on the line: at the last space within
// them, else at the first after them; npos if there is none. Spaces at the start do not count.
std::size_t BreakOf(std::string_view line, std::size_t columns) {
  std::size_t best = std::string_view::npos;
  const std::size_t text = line.find_first_not_of(' ');
  if (text == std::string_view::npos) return best;
  for (std::size_t at = line.find(' ', text); at != std::string_view::npos;
       at = line.find(' ', at + 1)) {
    if (best != std::string_view::npos && Width(line.substr(0, at)) > columns) break;
    best = at;
  }
  return best;
}

std::string LineFolded(std::string_view line, std::size_t columns) {
  constexpr std::size_t kHanging = 4;
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size()) + kHanging;
  std::string folded;
  std::size_t room = columns;
  while (Width(line) > room) {
    const std::size_t end = BreakOf(line, room);
    if (end == std::string_view::npos) break;
    folded += std::string(line.substr(0, end)) + "\n" + std::string(indent, ' ');
    line.remove_prefix(std::min(line.find_first_not_of(' ', end), line.size()));
    room = columns > indent ? columns - indent : 1;
  }
  return folded + std::string(line);
}

std::optional<std::string_view> Environment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

}  // namespace

std::string InColour(std::string_view text) {
  std::string coloured;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    coloured += LineInColour(text.substr(0, end));
    if (end == std::string_view::npos) break;
    coloured += '\n';
    text.remove_prefix(end + 1);
  }
  return coloured;
}

std::string Folded(std::string_view text, std::size_t columns) {
  std::string folded;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    folded += LineFolded(text.substr(0, end), columns);
    if (end == std::string_view::npos) break;
    folded += '\n';
    text.remove_prefix(end + 1);
  }
  return folded;
}

std::string TimeLeft(std::uint64_t done, std::uint64_t all, double gone_s) {
  if (done == 0) return "no estimate yet";
  const double left_s =
      gone_s * static_cast<double>(all - std::min(done, all)) / static_cast<double>(done);
  constexpr double kMinute_s = 60;
  if (left_s < 2 * kMinute_s) return fmt::format("about {:.0f} s left", left_s);
  return fmt::format("about {:.0f} min left", left_s / kMinute_s);
}

std::string ProgressLine(std::uint64_t done, std::uint64_t all, const std::string& text,
                         std::size_t columns) {
  constexpr std::size_t kMostBar = 30;
  constexpr std::size_t kLeastBar = 5;
  const std::size_t room = columns > text.size() + 4 ? columns - text.size() - 4 : 0;
  const std::size_t bar = std::min(room, kMostBar);
  std::string line = text;
  if (bar >= kLeastBar && all > 0) {
    const std::size_t full = bar * std::min(done, all) / all;
    line = "[" + std::string(full, '#') + std::string(bar - full, '.') + "] " + text;
  }
  if (line.size() >= columns) line.resize(columns > 0 ? columns - 1 : 0);
  return line;
}

std::string ForTerminal(const std::string& text) {
  if (::isatty(STDOUT_FILENO) != 1) return text;
  const std::string folded = FoldedForTerminal(text);
  const bool forbidden = Environment("NO_COLOR") || Environment("TERM").value_or("dumb") == "dumb";
  return forbidden ? folded : InColour(folded);
}

std::string FoldedForTerminal(const std::string& text) {
  if (::isatty(STDOUT_FILENO) != 1) return text;
  return Folded(text, static_cast<std::size_t>(SizeOfTerminal().columns));
}

std::size_t StderrColumns() {
  return static_cast<std::size_t>(SizeOfTerminal(STDERR_FILENO).columns);
}

}  // namespace giveway::fleetctl
