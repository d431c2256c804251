#include "services/fleetctl/run/black_box.h"

#include <fmt/format.h>

#include <cstdio>
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

bool WritePage(const std::string& path, const RunFrames& frames, const std::string& scene) {
  try {
    WriteFile(path, PageWithRun(frames.RunJson(scene)));
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "the page of what broke is not written: %s\n", error.what());
    return false;
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
                    std::async(std::launch::async, WritePage, path.string(), frames_, scene_)});
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
