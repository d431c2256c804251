#include "services/fleetctl/tune/tune_draw.h"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "services/fleetctl/process/child_process.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kDrawLimit = std::chrono::seconds(20);
constexpr int kNotFound = 127;  // what env(1) says of a program that is not there

// The exit code; nothing if it took too long or died.
std::optional<int> RunGnuplot(const std::string& program) {
  ChildProcess child({"gnuplot", {"/usr/bin/env", "gnuplot", program}, "", -1});
  const SteadyTime limit = SteadyNow() + kDrawLimit;
  while (child.IsRunning() && SteadyNow() < limit) {
    SleepUntil(SteadyNow() + std::chrono::milliseconds(10));
    child.Poll();
  }
  if (child.IsRunning() || child.End()->by_signal) return std::nullopt;
  return child.End()->number;
}

}  // namespace

std::vector<DrawnPlot> Draw(const std::vector<TunePlot>& plots, const TuneStore& store) {
  std::vector<DrawnPlot> drawn;
  for (const TunePlot& plot : plots) {
    const std::string svg = (store.Folder() / (plot.name + ".svg")).string();
    const std::string program = plot.name + ".gnuplot";
    std::string quoted;  // in gnuplot's single quotes a quote is said by two
    for (const char c : svg) quoted += c == '\'' ? std::string("''") : std::string(1, c);
    store.Write(program, "set output '" + quoted + "'\n" + plot.program);
    const std::optional<int> code = RunGnuplot((store.Folder() / program).string());
    if (code != 0) {
      std::fprintf(stderr, "no pictures: %s\n",
                   code == kNotFound ? "gnuplot is not installed (Debian: gnuplot-nox)"
                                     : "gnuplot did not draw them");
      return {};
    }
    std::ifstream stream(svg);
    drawn.push_back({plot.title, {std::istreambuf_iterator<char>(stream), {}}});
  }
  return drawn;
}

}  // namespace giveway::fleetctl
