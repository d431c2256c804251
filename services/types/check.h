// GIVEWAY_CHECK: a broken invariant is our bug. Always on; prints the values and aborts.
// Bad input never goes through here: it is refused at start-up or counted at run time.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace giveway {

// Prints "file:line: check failed: condition (values)" to stderr and aborts.
template <typename... Values>
[[noreturn]] void CheckFailed(const char* file, int line, const char* condition,
                              const Values&... values) {
  std::ostringstream text;
  ((text << ' ' << values), ...);
  std::fprintf(stderr, "%s:%d: check failed: %s%s\n", file, line, condition, text.str().c_str());
  std::abort();
}

}  // namespace giveway

// GIVEWAY_CHECK(condition, values...): the values are printed when the condition does not hold.
#define GIVEWAY_CHECK(condition, ...)                                                    \
  do {                                                                                   \
    if (!(condition)) [[unlikely]] {                                                     \
      ::giveway::CheckFailed(__FILE__, __LINE__, #condition __VA_OPT__(, ) __VA_ARGS__); \
    }                                                                                    \
  } while (false)
