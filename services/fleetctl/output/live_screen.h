// Shows the progress of a run: a table redrawn in place if stdout is a terminal, else one line a
// second on stderr. The destructor restores the cursor, and Interrupts where it is not reached.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "services/fleetctl/output/live_table.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

class LiveScreen {
 public:
  // `in_place`: draw the table on stdout.
  explicit LiveScreen(bool in_place);
  ~LiveScreen();
  LiveScreen(const LiveScreen&) = delete;
  LiveScreen& operator=(const LiveScreen&) = delete;

  // Draws if it is due.
  void Show(const TableView& view, SteadyTime now);
  // True if drawing is due; then not again until a period has passed.
  bool IsDue(SteadyTime now);
  // Draws these lines over the previous ones, on stdout.
  void Draw(const std::vector<std::string>& lines);
  // Leaves what is drawn and continues below it.
  void Finish();

 private:
  bool in_place_;
  bool cursor_hidden_ = false;
  std::size_t lines_drawn_ = 0;
  SteadyTime next_{0};
};

bool IsTerminal();

}  // namespace giveway::fleetctl
