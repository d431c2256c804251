#include "services/fleetctl/replay/replay.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <tuple>

#include "services/fleetctl/output/decision_trace.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/replay/replayer.h"
#include "services/recording/recording_file.h"

namespace giveway::fleetctl {
namespace {

ReplayedFile Unreadable(const std::string& why) {
  ReplayedFile outcome;
  outcome.finding = "cannot be read: " + why;
  return outcome;
}

// The file opened, or why it cannot be read.
std::string Open(const std::string& path, std::ifstream* stream) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return "it is a folder";
  stream->open(path, std::ios::binary);
  return *stream ? "" : std::strerror(errno);
}

ReplayedFile ReplayFile(const std::string& path, const ReplayWatcher& watch, Replayer* replayer) {
  std::ifstream stream;
  const std::string why = Open(path, &stream);
  if (!why.empty()) return Unreadable(why);
  ReplayedFile outcome = replayer->Replay(&stream, watch);
  return stream.bad() ? Unreadable(std::strerror(errno)) : outcome;
}

// Identifies a file's recording and its part of it; a pipe, which is read only once, and a file
// that cannot be read count as a recording of their own.
struct Place {
  std::uint32_t boot_epoch = 0;
  std::uint32_t vehicle = 0;
  std::size_t own = 0;  // the file's number, where it is a recording by itself
  std::uint32_t part = 1;
};

Place PlaceOf(const std::string& path, std::size_t number) {
  const Place by_itself{.own = number + 1};
  std::error_code error;
  std::ifstream stream;
  if (!std::filesystem::is_regular_file(path, error) || !Open(path, &stream).empty()) {
    return by_itself;
  }
  const RecordingFile file(&stream);
  if (file.Life()) return {file.Life()->boot_epoch, Number(file.Life()->options.id), 0, 1};
  if (!file.Continues()) return by_itself;
  return {file.Continues()->boot_epoch, Number(file.Continues()->vehicle), 0,
          file.Continues()->part};
}

auto RecordingOf(const Place& place) {
  return std::tuple(place.boot_epoch, place.vehicle, place.own);
}

// The numbers of the files, with the parts of a recording in sequence.
class ReplayOrder {
 public:
  explicit ReplayOrder(const std::vector<std::string>& files) {
    for (const std::string& path : files) {
      order_.push_back(places_.size());
      places_.push_back(PlaceOf(path, places_.size()));
    }
    std::ranges::stable_sort(order_, {}, [this](std::size_t file) {
      return std::tuple(RecordingOf(places_[file]), places_[file].part);
    });
  }
  const std::vector<std::size_t>& Files() const { return order_; }
  bool IsOneRecording() const {
    return RecordingOf(places_[order_.front()]) == RecordingOf(places_[order_.back()]);
  }

 private:
  std::vector<Place> places_;
  std::vector<std::size_t> order_;
};

// The vehicle's own estimate: its recording does not have the truth.
class Tracer {
 public:
  ReplayWatcher Watcher() {
    return [this](const RecordedStep& step, const Vehicle& brain, const Outputs& said) {
      if (!begun_) begun_ = step.now;
      AppendLine({.tick = brain.State().world.tick,
                  .time_s = Seconds(step.now - *begun_),
                  .vehicle = said.command.vehicle,
                  .world_from_body = said.beacon.world_from_body,
                  .forward_m_s = brain.SpeedMps(),
                  .arrived = brain.State().route.arrived},
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
  const ReplayOrder order(options.files);
  if (!options.trace_file.empty() && !order.IsOneRecording()) {
    std::fputs("--trace is of one recording: name the parts of one\n", stderr);
    return kCouldNotRun;
  }
  if (!options.trace_file.empty()) CheckWritable(options.trace_file);
  Tracer tracer;
  const ReplayWatcher watch = options.trace_file.empty() ? ReplayWatcher() : tracer.Watcher();
  std::vector<ReplayedFile> files(options.files.size());
  Replayer replayer;
  for (const std::size_t file : order.Files()) {
    files[file] = ReplayFile(options.files[file], watch, &replayer);
    files[file].file = options.files[file];
  }
  const std::string text = options.json ? ToJson(files) + "\n" : ForTerminal(ToText(files));
  const bool written = PrintAll(text);
  if (!written) std::fprintf(stderr, "cannot write the verdict to stdout\n");
  const int code = std::max(ExitCode(OverallVerdict(files)), written ? 0 : 1);
  if (options.trace_file.empty()) return code;
  return WriteAfterVerdict(code, [&] { WriteFile(options.trace_file, tracer.Text()); });
}

}  // namespace giveway::fleetctl
