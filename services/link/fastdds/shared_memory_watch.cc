#include "services/link/fastdds/shared_memory_watch.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
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

std::set<std::string> PortsOf(const std::vector<std::string>& open_files) {
  constexpr std::string_view kLock = "_el";
  std::set<std::string> ports;
  for (const std::string& file : open_files) {
    const bool is_port = std::ranges::any_of(kStarts, [&file](std::string_view start) {
      return file.starts_with(std::string(start) + "port");
    });
    if (is_port && file.ends_with(kLock)) ports.insert(file.substr(0, file.size() - kLock.size()));
  }
  return ports;
}

bool HoldsDeleted(const std::string& maps, const std::set<std::string>& files) {
  return std::ranges::any_of(files, [&maps](const std::string& file) {
    return maps.find(' ' + file + " (deleted)\n") != std::string::npos;
  });
}

bool AnyHoldsDeleted(const std::filesystem::path& processes, const std::set<std::string>& files) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (fs::directory_iterator at(processes, error), end; !error && at != end; at.increment(error)) {
    if (at->path().filename().string().find_first_not_of("0123456789") != std::string::npos)
      continue;
    std::ifstream maps(at->path() / "maps");
    for (std::string line; std::getline(maps, line);) {
      if (HoldsDeleted(line + '\n', files)) return true;
    }
  }
  return false;
}

bool SharedMemoryWatch::IsGone(SteadyTime now) {
  if (gone_ || (next_ && now < *next_)) return gone_;
  const std::vector<std::string> open_files = LinksIn("/proc/self/fd");
  gone_ = IsSegmentGone(open_files) || (!next_ && AnyHoldsDeleted("/proc", PortsOf(open_files)));
  next_ = now + std::chrono::seconds(1);
  return gone_;
}

}  // namespace giveway::link
