#include "services/fleetctl/run/black_box.h"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <system_error>
#include <utility>

#include "services/fleetctl/output/output_file.h"
#include "services/observer/fleet/scene_json.h"
#include "services/observer/page/page_text.h"
#include "services/runtime/signals_blocked.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

// A resumed soak keeps the pages written before the crash.
fs::path FreePage(const fs::path& folder, std::size_t* number) {
  std::error_code error;
  while (true) {
    fs::path page = folder / fmt::format("black-box-{}.html", ++*number);
    if (!fs::exists(page, error)) return page;
  }
}

void SayNotWritten(const std::exception& error) {
  std::fprintf(stderr, "the page of what broke is not written: %s\n", error.what());
}

bool WritePage(const std::string& path, const RunFrames& frames, const std::string& scene) {
  try {
    WriteFile(path, PageWithRun(frames.RunJson(scene)));
    return true;
  } catch (const std::exception& error) {
    SayNotWritten(error);
    return false;
  }
}

// On a thread of its own. That it cannot be started must not end the soak that found something.
std::shared_future<bool> StartToWrite(const std::string& path, const RunFrames& frames,
                                      const std::string& scene) {
  try {
    return std::async(std::launch::async, WritePage, path, frames, scene);
  } catch (const std::system_error& error) {
    SayNotWritten(error);
    std::promise<bool> not_written;
    not_written.set_value(false);
    return not_written.get_future();
  }
}

}  // namespace

BlackBox::BlackBox(const Scenario& scenario, fs::path folder, Nanoseconds last)
    : scene_(SceneJson({"soak", scenario})), folder_(std::move(folder)), frames_(last) {}

void BlackBox::Fold(const link::Observed& observed, SteadyTime now) {
  view_.Fold(observed, now);
  frames_.Note(view_, now);
}

void BlackBox::Write() {
  const fs::path path = FreePage(folder_, &number_);
  const SignalsBlocked blocked;  // signals are the loop's
  pages_.push_back({(folder_.filename() / path.filename()).string(),
                    StartToWrite(path.string(), frames_, scene_)});
}

void BlackBox::Finish() {
  for (const Page& page : pages_) page.written.wait();
}

std::string BlackBox::Written(std::size_t page) const {
  if (page >= pages_.size()) return {};
  const auto& [name, written] = pages_[page];
  const bool ended = written.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  return ended && written.get() ? name : std::string();
}

}  // namespace giveway::fleetctl
