#include "services/fleetctl/replay.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "services/fleetctl/decision_trace.h"
#include "services/fleetctl/exit_codes.h"
#include "services/fleetctl/output_file.h"
#include "services/fleetctl/replayer.h"

namespace giveway::fleetctl {
namespace {

app::ReplayedFile Unreadable(const std::string& why) {
  app::ReplayedFile outcome;
  outcome.finding = "cannot be read: " + why;
  return outcome;
}

app::ReplayedFile ReplayFile(const std::string& path, const ReplayWatcher& watch) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return Unreadable("it is a folder");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Unreadable(std::strerror(errno));
  app::ReplayedFile outcome = Replay(&stream, watch);
  return stream.bad() ? Unreadable(std::strerror(errno)) : outcome;
}

// Where the vehicle believed it was: its truth is not in its recording.
class Tracer {
 public:
  ReplayWatcher Watcher() {
    return [this](const app::RecordedStep& step, const Vehicle& brain, const Outputs& said) {
      if (!begun_) begun_ = step.now;
      AppendLine({.tick = brain.State().tick,
                  .time_s = Seconds(step.now - *begun_),
                  .vehicle = said.command.vehicle,
                  .world_from_body = said.beacon.world_from_body,
                  .forward_m_s = brain.SpeedMps(),
                  .arrived = brain.State().arrived},
                 said, &text_);
    };
  }
  const std::string& Text() const { return text_; }

 private:
  std::optional<SteadyTime> begun_;
  std::string text_{kTraceHead};
};

}  // namespace

int RunReplay(const ReplayOptions& options) {
  if (!options.trace_file.empty()) CheckWritable(options.trace_file);
  Tracer tracer;
  const ReplayWatcher watch = options.trace_file.empty() ? ReplayWatcher() : tracer.Watcher();
  std::vector<app::ReplayedFile> files;
  for (const std::string& path : options.files) {
    files.push_back(ReplayFile(path, watch));
    files.back().file = path;
  }
  if (!options.trace_file.empty()) WriteFile(options.trace_file, tracer.Text());
  const std::string text = options.json ? app::ToJson(files) + "\n" : app::ToText(files);
  std::fputs(text.c_str(), stdout);
  const int code = app::ExitCode(app::Judge(files));
  if (std::fflush(stdout) == 0) return code;
  std::fprintf(stderr, "cannot write the verdict to stdout\n");
  return std::max(code, 1);
}

}  // namespace giveway::fleetctl
