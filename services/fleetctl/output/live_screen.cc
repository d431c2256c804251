#include "services/fleetctl/output/live_screen.h"

#include <unistd.h>

#include <cstdio>

#include "services/fleetctl/output/library_lines.h"
#include "services/fleetctl/process/interrupts.h"

namespace giveway::fleetctl {
namespace {

constexpr SteadyTime kTablePeriod = std::chrono::milliseconds(200);
constexpr SteadyTime kLinePeriod = std::chrono::seconds(1);

// ECMA-48 control sequences.
constexpr const char* kHideCursor = "\x1b[?25l";
constexpr const char* kShowCursor = "\x1b[?25h";
constexpr const char* kClearLine = "\x1b[2K";
constexpr const char* kClearBelow = "\x1b[J";

void Write(const std::string& text, std::FILE* stream) {
  std::fputs(text.c_str(), stream);
  std::fflush(stream);
}

}  // namespace

bool IsTerminal() { return ::isatty(STDOUT_FILENO) == 1; }

LiveScreen::LiveScreen(bool in_place) : in_place_(in_place) {}

LiveScreen::~LiveScreen() { Finish(); }

bool LiveScreen::IsDue(SteadyTime now) {
  if (now < next_) return false;
  next_ = now + (in_place_ ? kTablePeriod : kLinePeriod);
  return true;
}

void LiveScreen::Show(const TableView& view, SteadyTime now) {
  if (!IsDue(now)) return;
  if (in_place_) {
    Draw(TableLines(view, SizeOfTerminal()));
  } else {
    Write(ProgressLine(view) + "\n", stderr);
  }
}

void LiveScreen::Finish() {
  if (cursor_hidden_) Write(kShowCursor, stdout);
  Interrupts::WriteIfEnded(nullptr);
  cursor_hidden_ = false;
  lines_drawn_ = 0;
}

void LiveScreen::Draw(const std::vector<std::string>& lines) {
  std::string text;
  if (!cursor_hidden_) text += kHideCursor;
  cursor_hidden_ = true;
  Interrupts::WriteIfEnded(kShowCursor);
  if (lines_drawn_ > 0) text += "\x1b[" + std::to_string(lines_drawn_) + "A";
  for (const std::string& line : TakeLibraryLines()) text += kClearLine + line + "\n";
  for (const std::string& line : lines) text += kClearLine + line + "\n";
  text += kClearBelow;
  lines_drawn_ = lines.size();
  Write(text, stdout);
}

}  // namespace giveway::fleetctl
