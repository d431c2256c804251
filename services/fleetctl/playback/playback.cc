#include "services/fleetctl/playback/playback.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <utility>

#include "services/config/scenario_file.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/observer/capture/run_frames.h"
#include "services/observer/fleet/scene_json.h"
#include "services/observer/page/page_text.h"
#include "services/observer/server/page_server.h"
#include "services/runtime/process.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

constexpr int kNothingToShow = 1;
constexpr std::size_t kMostFaultBytes = 400;  // it may have a name from the file

std::string SceneOf(const PlaybackOptions& options) {
  SceneSource source{
      (options.report ? "" : "replay of ") + options.file.substr(options.file.rfind('/') + 1),
      std::nullopt};
  if (!options.scenario.empty()) source.scenario = LoadScenario(options.scenario, {});
  return SceneJson(source);
}

void Explain(const std::string& file, const RunRead& run) {
  if (!run.result.fault.empty()) {
    std::fprintf(stderr, "%s: %s%s\n", file.c_str(),
                 Printable(Shortened(run.result.fault, kMostFaultBytes)).c_str(),
                 run.frames.Size() > 0 ? "; shown up to there" : "");
  }
  if (run.unreadable > 0) {
    std::fprintf(stderr, "%s: %llu samples could not be decoded\n", file.c_str(),
                 static_cast<unsigned long long>(run.unreadable));
  }
  if (run.result.cut_off) {
    std::fprintf(stderr, "%s: ends without its summary, as after kill -9; shown up to there\n",
                 file.c_str());
  }
}

// Until Ctrl-C.
void Serve(const PlaybackOptions& options, std::string page) {
  const Interrupts interrupts;
  const PageServer server(options.address, options.port,
                          {.page = std::move(page),
                           .get = [](const auto&, const auto&) { return std::nullopt; },
                           .scene = "",
                           .frames = nullptr,
                           .host_names = {}});
  std::fprintf(stderr, "http://%s:%u/ shows it; Ctrl-C ends\n", options.address.c_str(),
               static_cast<unsigned>(options.port));
  while (Interrupts::Count() == 0) SleepUntil(SteadyNow() + std::chrono::milliseconds(50));
}

}  // namespace

bool IsMcapFile(const std::string& file) { return file.ends_with(".mcap"); }

int RunPlayback(const PlaybackOptions& options) {
  std::ifstream file(options.file, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read: %s\n", options.file.c_str(), std::strerror(errno));
    return kCouldNotRun;
  }
  if (!options.html_file.empty()) CheckWritable(options.html_file);
  const std::string scene = SceneOf(options);
  RunRead run = ReadRun([&file](char* to, std::size_t most) {
    file.read(to, static_cast<std::streamsize>(most));
    return static_cast<std::size_t>(file.gcount());
  });
  Explain(options.file, run);
  if (run.frames.Size() == 0) {
    std::fprintf(stderr, "%s: there is nothing of a fleet in it\n", options.file.c_str());
    return run.result.fault.empty() ? kNothingToShow : kCouldNotRun;
  }
  std::string page = PageWithRun(run.frames.RunJson(
      scene, options.report ? RunFrames::Opens::kReport : RunFrames::Opens::kMap));
  run.frames = {};
  // What could be read is shown, but a script must not take it for the whole run.
  const int code = run.result.fault.empty() ? 0 : kCouldNotRun;
  if (options.html_file.empty()) {
    Serve(options, std::move(page));
  } else {
    WriteFile(options.html_file, page);
    if (options.report) std::printf("%s\n", options.html_file.c_str());
  }
  return code;
}

}  // namespace giveway::fleetctl
