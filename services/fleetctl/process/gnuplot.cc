#include "services/fleetctl/process/gnuplot.h"

#include "services/fleetctl/process/child_process.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kDrawLimit = std::chrono::seconds(20);
constexpr int kNotFound = 127;  // the code of env(1) for a missing program

}  // namespace

std::string RunGnuplot(const std::string& program_file) {
  ChildProcess child({"gnuplot", {"/usr/bin/env", "gnuplot", program_file}, "", -1});
  const SteadyTime limit = SteadyNow() + kDrawLimit;
  while (child.IsRunning() && SteadyNow() < limit) {
    SleepUntil(SteadyNow() + std::chrono::milliseconds(10));
    child.Poll();
  }
  if (child.IsRunning()) return "gnuplot took longer than 20 s";
  if (*child.End() == ProcessEnd{false, 0}) return "";
  if (*child.End() == ProcessEnd{false, kNotFound}) return kGnuplotIsMissing;
  return "gnuplot did not draw it: " +
         (child.LastLines().empty() ? Describe(*child.End()) : child.LastLines().back());
}

std::string GnuplotQuoted(const std::string& text) {
  std::string quoted = "'";  // within single quotes a quote is doubled
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace giveway::fleetctl
