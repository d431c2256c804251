#include "services/fleetctl/output/output_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kRemedy = "; name a file in a folder that exists and is yours to write";

void ThrowIf(const std::string& complaint) {
  if (!complaint.empty()) throw OutputError(complaint + kRemedy);
}

}  // namespace

void CheckWritable(const std::string& path) { ThrowIf(WhyNotWritable(path)); }

void CheckFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) ThrowIf(folder + ": cannot be made: " + error.message());
  CheckWritable((std::filesystem::path(folder) / "world.log").string());
}

void WriteFile(const std::string& path, const std::string& text) {
  ThrowIf(WriteOutputFile(path, text));
}

int WriteAfterVerdict(int code, const std::function<void()>& write) {
  try {
    write();
    return code;
  } catch (const OutputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return std::max(code, 1);
  }
}

}  // namespace giveway::fleetctl
