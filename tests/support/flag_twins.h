// The environment twins of a program's flags, by what its help lists.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/config/flag_values.h"

namespace giveway::test {

inline std::vector<std::string> FlagTwins(std::string_view help) {
  constexpr std::string_view kRow = "\n  --";
  std::vector<std::string> twins;
  for (auto at = help.find(kRow); at != std::string_view::npos; at = help.find(kRow, at + 1)) {
    const std::string_view flag = help.substr(at + 3);
    const std::string_view name = flag.substr(0, flag.find_first_of(" \n"));
    if (name != "--version") twins.push_back(TwinOf(name));
  }
  return twins;
}

}  // namespace giveway::test
