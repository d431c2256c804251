// How large the terminal is that something is written to. Whether it is one is another question.
#pragma once

namespace giveway {

struct TerminalSize {
  int columns = 80;
  int rows = 24;
};

// Of the terminal on this descriptor, stdout if none is named; the usual 80 by 24 where it is none.
TerminalSize SizeOfTerminal(int descriptor = 1);

}  // namespace giveway
