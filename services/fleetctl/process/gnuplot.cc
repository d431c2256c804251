#include "services/fleetctl/process/gnuplot.h"

#include <optional>

#include "services/fleetctl/process/child_process.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kDrawLimit = std::chrono::seconds(20);
constexpr int kNotFound = 127;  // what env(1) says of a program that is not there

// The exit code; nothing if it took too long or died.
std::optional<int> ExitCodeOfGnuplot(const std::string& program_file) {
  ChildProcess child({"gnuplot", {"/usr/bin/env", "gnuplot", program_file}, "", -1});
  const SteadyTime limit = SteadyNow() + kDrawLimit;
  while (child.IsRunning() && SteadyNow() < limit) {
    SleepUntil(SteadyNow() + std::chrono::milliseconds(10));
    child.Poll();
  }
  if (child.IsRunning() || child.End()->by_signal) return std::nullopt;
  return child.End()->number;
}

}  // namespace

std::string RunGnuplot(const std::string& program_file) {
  const std::optional<int> code = ExitCodeOfGnuplot(program_file);
  if (code == 0) return "";
  return code == kNotFound ? "gnuplot is not installed (Debian: gnuplot-nox)"
                           : "gnuplot did not draw them";
}

std::string GnuplotQuoted(const std::string& text) {
  std::string quoted = "'";  // in single quotes a quote is said by two
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace giveway::fleetctl
