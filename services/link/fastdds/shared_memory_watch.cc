#include "services/link/fastdds/shared_memory_watch.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
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

std::uint64_t InodeOf(const std::string& file) {
  struct stat found {};
  return ::stat(file.c_str(), &found) == 0 ? found.st_ino : 0;
}

// What each process has in its memory, as far as this one may read it.
bool AnyHoldsDeleted(const std::set<std::string>& files) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (fs::directory_iterator at("/proc", error), end; !error && at != end; at.increment(error)) {
    if (at->path().filename().string().find_first_not_of("0123456789") != std::string::npos)
      continue;
    std::ifstream maps(at->path() / "maps");
    const std::string text{std::istreambuf_iterator<char>(maps), {}};
    if (HoldsDeleted(text, files)) return true;
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

// Other processes are looked at only where a port has another file than before: at the start, and
// where the library has replaced one.
bool SharedMemoryWatch::IsPortReplaced(const std::vector<std::string>& open_files) {
  const std::set<std::string> files = PortsOf(open_files);
  std::set<std::pair<std::string, std::uint64_t>> ports;
  for (const std::string& file : files) ports.emplace(file, InodeOf(file));
  if (ports == ports_) return false;
  ports_ = std::move(ports);
  return AnyHoldsDeleted(files);
}

bool SharedMemoryWatch::IsGone() {
  const SteadyTime now(std::chrono::steady_clock::now().time_since_epoch());
  if (gone_ || now < next_) return gone_;
  next_ = now + std::chrono::seconds(1);
  const std::vector<std::string> open_files = LinksIn("/proc/self/fd");
  gone_ = IsSegmentGone(open_files) || IsPortReplaced(open_files);
  return gone_;
}

}  // namespace giveway::link
