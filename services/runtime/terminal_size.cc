#include "services/runtime/terminal_size.h"

#include <sys/ioctl.h>

namespace giveway {

TerminalSize SizeOfTerminal(int descriptor) {
  winsize size{};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return {};
  return {size.ws_col, size.ws_row};
}

}  // namespace giveway
