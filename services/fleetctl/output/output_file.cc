#include "services/fleetctl/output/output_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

constexpr std::array kPassing = {ENOSPC, EDQUOT, EIO, ESTALE, EROFS, EMFILE, ENFILE};

bool MayPass(int error) { return std::ranges::find(kPassing, error) != kPassing.end(); }

void Throw(const std::string& complaint, int error) {
  const char* remedy = MayPass(error)
                           ? "; see to that disk or limit, or name another place"
                           : "; name a file in a folder that exists and is yours to write";
  throw OutputError(complaint + remedy, error);
}

// Of a complaint that errno belongs to.
void ThrowIf(const std::string& complaint) {
  const int error = errno;
  if (!complaint.empty()) Throw(complaint, error);
}

}  // namespace

bool OutputError::MayPass() const { return fleetctl::MayPass(error_); }

void CheckWritable(const std::string& path) { ThrowIf(WhyNotWritable(path)); }

void CheckFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) Throw(folder + ": cannot be made: " + error.message(), error.value());
  CheckWritable((std::filesystem::path(folder) / "world.log").string());
}

void WriteFile(const std::string& path, const std::string& text) {
  ThrowIf(WriteOutputFile(path, text));
}

bool PrintAll(const std::string& text) {
  const bool put = std::fputs(text.c_str(), stdout) >= 0;
  return std::fflush(stdout) == 0 && put;
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
