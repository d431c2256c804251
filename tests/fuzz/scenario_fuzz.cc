// Any text as a scenario file: either a scenario that keeps every rule, in which a fleet can begin
// to drive, or problems that a person can read.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/types/check.h"
#include "sim_world/virtual/virtual_fleet.h"
#include "tests/fuzz/outputs.h"
#include "tests/fuzz/scenario_rules.h"
#include "tests/fuzz/target.h"

namespace giveway::fuzz {
namespace {

// A file in memory, for a loader that knows files only.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("scenario", MFD_CLOEXEC)) {
    GIVEWAY_CHECK(descriptor_ >= 0);
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void Hold(const std::uint8_t* data, std::size_t size) {
    GIVEWAY_CHECK(ftruncate(descriptor_, 0) == 0);
    GIVEWAY_CHECK(pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size));
  }
  std::string Path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void CheckProblems(const InputError& error) {
  GIVEWAY_CHECK(!error.Problems().empty());
  const std::string text = Format(error.Problems());
  GIVEWAY_CHECK(IsUtf8(text), text);
  GIVEWAY_CHECK(text == error.what());
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  GIVEWAY_CHECK(lines == error.Problems().size(), lines, text);
  for (const Problem& problem : error.Problems()) {
    GIVEWAY_CHECK(!problem.message.empty() && !problem.remedy.empty() && problem.line >= 0, text);
  }
}

// The first ticks of what was accepted: nobody says what another must refuse.
void CheckDrives(const Scenario& scenario) {
  constexpr std::size_t kLargest = 6;
  constexpr int kTicks = 4;
  if (scenario.vehicles.size() > kLargest) return;
  sim::VirtualFleet fleet(scenario);
  bool running = true;
  for (int tick = 0; tick < kTicks && running; ++tick) {
    running = fleet.Advance();
    for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
      CheckOutputs(fleet.Said(i), scenario.vehicles[i]);
      GIVEWAY_CHECK(fleet.Brain(i).State().beacons.Rejected() == 0, i);
    }
  }
}

}  // namespace

std::vector<Input> Samples() {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const char* folder : {GIVEWAY_SCENARIOS, GIVEWAY_BAD_SCENARIOS, GIVEWAY_FUZZ_SCENARIOS}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".textproto") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<Input> samples;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    samples.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return samples;
}

}  // namespace giveway::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace giveway;
  static fuzz::MemoryFile file;
  file.Hold(data, size);
  try {
    const Scenario scenario = LoadScenario(file.Path(), {});
    fuzz::CheckScenario(scenario);
    fuzz::CheckDrives(scenario);
  } catch (const InputError& error) {
    fuzz::CheckProblems(error);
  }
  return 0;
}
