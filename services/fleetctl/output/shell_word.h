// Words of a command line that a person can paste into a shell.
#pragma once

#include <string>

namespace giveway::fleetctl {

// Quoted as one word of a shell, where it needs that.
std::string ShellWord(const std::string& text);

}  // namespace giveway::fleetctl
