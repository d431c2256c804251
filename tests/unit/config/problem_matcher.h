// One problem of a scenario file: its line, its field, and some words of its message.
#pragma once

#include <gmock/gmock.h>

namespace giveway {

MATCHER_P3(Is, line, field, message, "") {
  *result_listener << arg.line << " " << arg.field << " = " << arg.value << ": " << arg.message
                   << "; " << arg.remedy;
  return arg.line == line && arg.field == field && !arg.remedy.empty() && !arg.file.empty() &&
         arg.message.find(message) != std::string::npos;
}

}  // namespace giveway
