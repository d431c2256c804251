// Any bytes as a profile file: findings that a person can read, the same each time, and never
// silence where nothing can be loaded.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "services/qos/profile_check.h"
#include "services/types/check.h"
#include "tests/fuzz/target.h"

namespace giveway::fuzz {
namespace {

void CheckFinding(const qos::Finding& finding, int lines) {
  GIVEWAY_CHECK(!finding.rule.empty() && !finding.values.empty(), finding.rule);
  GIVEWAY_CHECK(!finding.consequence.empty() && !finding.remedy.empty(), finding.rule);
  GIVEWAY_CHECK(finding.place.line >= 0 && finding.place.line <= lines, finding.place.line, lines);
}

}  // namespace

std::vector<Input> Samples() {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const char* folder : {GIVEWAY_QOS_SETS, GIVEWAY_BAD_QOS}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".xml") files.push_back(entry.path());
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
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const auto lines = static_cast<int>(std::count(bytes.begin(), bytes.end(), '\n')) + 1;
  // A byte of it chooses the fleet, so that rules about its size are tried, too.
  const qos::Deployment deployment{.vehicles = 1 + (size > 0 ? data[size / 2] : 0)};
  const qos::Findings findings = qos::Check({{"qos.xml", bytes}}, deployment);
  for (const qos::Finding& finding : findings) fuzz::CheckFinding(finding, lines);
  GIVEWAY_CHECK(findings.size() <= qos::kMostFindings + 1, findings.size());
  const qos::Findings again = qos::Check({{"qos.xml", bytes}}, deployment);
  GIVEWAY_CHECK(findings.size() == again.size(), findings.size(), again.size());
  // What is not even marked up as a set cannot be clean.
  GIVEWAY_CHECK(!findings.empty() || bytes.find("giveway_participant") != std::string::npos);
  return 0;
}
