#include "services/runtime/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

namespace giveway {
namespace {

namespace fs = std::filesystem;

// 0, or the errno.
int WriteAll(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

// A temporary file next to its target; gone with this object unless it was renamed to the target.
class Beside {
 public:
  Beside(std::string name, int descriptor) : name_(std::move(name)), descriptor_(descriptor) {}
  ~Beside() {
    const int why = errno;  // of what failed before
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
    errno = why;
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  bool IsOpen() const { return descriptor_ >= 0; }
  // As the file it replaces is; a new one as any program's.
  void TakeModeOf(const std::string& path) const {
    struct stat there {};
    if (::stat(path.c_str(), &there) == 0) ::fchmod(descriptor_, there.st_mode & 07777);
  }
  // False: errno says why.
  bool Write(std::string_view bytes, bool wait_for_disk) {
    int fault = WriteAll(descriptor_, bytes);
    if (fault == 0 && wait_for_disk && ::fsync(descriptor_) != 0) fault = errno;
    if (::close(std::exchange(descriptor_, -1)) != 0 && fault == 0) fault = errno;
    errno = fault;
    return fault == 0;
  }
  bool PutInPlace(const std::string& path) {
    if (::rename(name_.c_str(), path.c_str()) != 0) return false;
    name_.clear();
    return true;
  }

 private:
  std::string name_;
  int descriptor_;
};

// One name for all writers of one state: what a killed one left is not left for ever. A link that
// was put there is removed, not followed.
Beside MakeForState(const std::string& path) {
  const std::string name = path + ".new";
  ::unlink(name.c_str());
  const int descriptor =
      ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
  return {descriptor < 0 ? "" : name, descriptor};
}

// A name of its own for each writer: two may write the same output at once.
Beside MakeForOutput(const std::string& path) {
  for (int i = 0;; ++i) {
    const std::string name =
        path + "." + std::to_string(::getpid()) + "-" + std::to_string(i) + ".new";
    const int descriptor =
        ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST) continue;
    return {descriptor < 0 ? "" : name, descriptor};
  }
}

// Where the file is that a name leads to.
std::string Followed(const std::string& path) {
  std::error_code error;
  const fs::path there = fs::weakly_canonical(path, error);
  return error ? path : there.string();
}

// Whether a name leads through a descriptor of a process, as /dev/stdout and /dev/fd/3 do. What is
// there is open already: another file in its place would not be the one that is open.
bool IsThroughDescriptor(fs::path path) {
  constexpr int kMostLinks = 40;  // that the kernel follows
  std::error_code error;
  for (int i = 0; i < kMostLinks; ++i) {
    const fs::path folder = fs::canonical(path.has_parent_path() ? path.parent_path() : ".", error);
    if (error) return false;
    if (folder.string().starts_with("/proc/") && folder.filename() == "fd") return true;
    const fs::path to = fs::read_symlink(path, error);
    if (error) return false;  // no link
    path = folder / to;
  }
  return false;
}

// Also a regular file that is reached through a descriptor. What is a file in /dev/shm is one.
bool IsSpecial(const std::string& path) {
  struct stat there {};
  const bool is_there = ::stat(path.c_str(), &there) == 0;
  return (is_there && !S_ISREG(there.st_mode)) || IsThroughDescriptor(path);
}

// Of a device, a pipe or an open file; nothing for any other file. Without bytes it is only opened.
std::optional<std::string> WriteSpecial(const std::string& path, std::string_view bytes) {
  if (!IsSpecial(path)) return std::nullopt;
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor < 0) return FileComplaint(path, "cannot be written");
  const int fault = WriteAll(descriptor, bytes);
  ::close(descriptor);
  errno = fault;
  return fault == 0 ? std::string() : FileComplaint(path, "cannot be written");
}

}  // namespace

std::string FileComplaint(const std::string& path, const char* what) {
  return path + ": " + what + ": " + std::strerror(errno);
}

std::optional<std::string> ReadWholeFile(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return std::nullopt;
  std::string bytes;
  std::array<char, 4096> part{};
  ssize_t got = 0;
  do {
    got = ::read(descriptor, part.data(), part.size());
    if (got > 0) bytes.append(part.data(), static_cast<std::size_t>(got));
  } while (got > 0 || (got < 0 && errno == EINTR));
  const int fault = errno;
  ::close(descriptor);
  errno = fault;
  return got == 0 ? std::optional(std::move(bytes)) : std::nullopt;
}

std::string WriteStateFile(const std::string& path, std::string_view bytes) {
  Beside file = MakeForState(path);
  if (!file.IsOpen() || !file.Write(bytes, false)) return FileComplaint(path, "cannot be written");
  return file.PutInPlace(path) ? std::string() : FileComplaint(path, "cannot be replaced");
}

std::string WriteOutputFile(const std::string& path, std::string_view bytes) {
  if (const auto outcome = WriteSpecial(path, bytes)) return *outcome;
  const std::string target = Followed(path);
  Beside file = MakeForOutput(target);
  if (!file.IsOpen()) return FileComplaint(path, "cannot be written");
  file.TakeModeOf(target);
  if (!file.Write(bytes, true)) return FileComplaint(path, "cannot be written");
  return file.PutInPlace(target) ? std::string() : FileComplaint(path, "cannot be replaced");
}

std::string WhyNotWritable(const std::string& path) {
  if (const auto outcome = WriteSpecial(path, "")) return *outcome;
  const std::string target = Followed(path);
  const bool is_there = ::access(target.c_str(), F_OK) == 0;
  if (is_there && ::access(target.c_str(), W_OK) != 0)
    return FileComplaint(path, "cannot be written");
  return MakeForOutput(target).IsOpen() ? std::string() : FileComplaint(path, "cannot be written");
}

}  // namespace giveway
