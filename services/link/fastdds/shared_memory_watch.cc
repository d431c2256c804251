#include "services/link/fastdds/shared_memory_watch.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace giveway::link {
namespace {

// Fast DDS 2 names its files fastrtps_, 3 fastdds_; a segment then has sixteen hexadecimal digits.
// Its maker alone keeps the lock, which is its name and _el, open.
constexpr std::string_view kStarts[] = {"/dev/shm/fastrtps_", "/dev/shm/fastdds_"};
constexpr std::string_view kEnd = "_el (deleted)";  // as Linux names what was deleted
constexpr std::size_t kDigits = 16;

bool IsDeletedLock(std::string_view file) {
  for (const std::string_view start : kStarts) {
    if (!file.starts_with(start) || !file.ends_with(kEnd)) continue;
    if (file.size() != start.size() + kDigits + kEnd.size()) continue;
    const std::string_view name = file.substr(start.size(), kDigits);
    return name.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  }
  return false;
}

}  // namespace

std::vector<std::string> LinksIn(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<std::string> links;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code closed_meanwhile;
    const fs::path target = fs::read_symlink(at->path(), closed_meanwhile);
    if (!closed_meanwhile) links.push_back(target.string());
  }
  return links;
}

bool IsSegmentGone(const std::vector<std::string>& open_files) {
  return std::ranges::any_of(open_files, IsDeletedLock);
}

bool SharedMemoryWatch::IsGone() {
  const SteadyTime now(std::chrono::steady_clock::now().time_since_epoch());
  if (gone_ || now < next_) return gone_;
  next_ = now + std::chrono::seconds(1);
  gone_ = IsSegmentGone(LinksIn("/proc/self/fd"));
  return gone_;
}

}  // namespace giveway::link
