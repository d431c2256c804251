#include "services/fleetctl/soak/host_faults/private_shm.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/statvfs.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>

#include "services/fleetctl/process/child_process.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

// Enough for the segments of fifty participants, small enough to be filled at once.
constexpr const char* kMountOptions = "size=256m,mode=1777";
constexpr const char* kFiller = "filler";
constexpr std::size_t kBlock = 1 << 20;
// Names that the library gives its files: segments, and the ports that receivers listen at.
constexpr std::string_view kSegment = "fastrtps_";
constexpr std::string_view kPort = "fastrtps_port";

// fastrtps_0123456789abcdef, without the lock file of the same name with _el appended.
bool IsSegment(const std::string& name) {
  return name.starts_with(kSegment) && !name.starts_with(kPort) && !name.ends_with("_el");
}

std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) files.push_back(entry.path());
  return files;
}

std::uint64_t FreeBytes(const fs::path& folder) {
  struct statvfs state {};
  if (::statvfs(folder.c_str(), &state) != 0) return 0;
  return state.f_bavail * state.f_frsize;
}

}  // namespace

const char* WhyNoPrivateShm() {
  // A thread may have mounts of its own although its process has none.
  bool may = false;
  std::thread([&may] { may = ::unshare(CLONE_NEWNS) == 0; }).join();
  return may ? nullptr
             : "/dev/shm is shared with every other fleet of this machine; root could have one "
               "apart";
}

PrivateShm::PrivateShm() {
  if (::unshare(CLONE_NEWNS) != 0 ||
      ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      ::mount("tmpfs", folder_.c_str(), "tmpfs", MS_NOSUID | MS_NODEV, kMountOptions) != 0) {
    throw StartError(fmt::format("cannot have a /dev/shm apart: {}", std::strerror(errno)));
  }
}

std::size_t PrivateShm::DeleteAll() {
  std::size_t deleted = 0;
  for (const fs::path& file : FilesIn(folder_)) {
    std::error_code failed;
    deleted += fs::remove(file, failed) ? 1 : 0;
  }
  return deleted;
}

std::size_t PrivateShm::LeaveOver(std::size_t count) {
  std::vector<fs::path> segments;
  for (const fs::path& file : FilesIn(folder_)) {
    if (IsSegment(file.filename().string())) segments.push_back(file);
  }
  std::size_t made = 0;
  for (std::size_t i = 0; i < count && !segments.empty(); ++i) {
    const fs::path copy = folder_ / fmt::format("{}dead{:012x}", kSegment, left_over_.size());
    std::error_code failed;
    if (!fs::copy_file(segments[i % segments.size()], copy, failed)) continue;
    left_over_.push_back(copy);
    ++made;
  }
  return made;
}

void PrivateShm::RemoveLeftOver() {
  for (const fs::path& file : left_over_) {
    std::error_code failed;
    fs::remove(file, failed);
  }
  left_over_.clear();
}

bool PrivateShm::Fill() {
  std::ofstream filler(folder_ / kFiller, std::ios::binary);
  const std::string block(kBlock, '\1');
  while (filler.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) {
  }
  filler.clear();
  while (filler.write(block.data(), 4096).flush()) {
  }
  return FreeBytes(folder_) == 0;
}

void PrivateShm::Empty() {
  std::error_code failed;
  fs::remove(folder_ / kFiller, failed);
}

}  // namespace giveway::fleetctl
