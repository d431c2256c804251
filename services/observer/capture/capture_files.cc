#include "services/observer/capture/capture_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>

#include "services/runtime/whole_file.h"

namespace giveway {
namespace {

namespace fs = std::filesystem;

// OUT.mcap and 3: OUT-0003.mcap.
std::string PartPath(const std::string& path, std::uint32_t part) {
  constexpr std::string_view kEnding = ".mcap";
  const bool ends = path.ends_with(kEnding);
  return fmt::format("{}-{:04}{}", path.substr(0, path.size() - (ends ? kEnding.size() : 0)), part,
                     kEnding);
}

// The 3 of PartPath; nothing where the file is no part.
std::optional<std::uint32_t> NumberOfPart(const std::string& path, const fs::path& file) {
  const std::string name = file.filename();
  const std::size_t dash = name.rfind('-');
  if (dash == std::string::npos) return std::nullopt;
  std::uint32_t number = 0;
  std::from_chars(name.data() + dash + 1, name.data() + name.size(), number);
  const bool is_part = number > 0 && name == fs::path(PartPath(path, number)).filename();
  return is_part ? std::optional(number) : std::nullopt;
}

// Paths of the parts in the folder, by their numbers.
std::map<std::uint32_t, std::string> PartsOf(const std::string& path) {
  std::map<std::uint32_t, std::string> parts;
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;
  for (fs::directory_iterator file(folder.empty() ? "." : folder, error), end;
       !error && file != end; file.increment(error)) {
    if (const auto number = NumberOfPart(path, *file)) parts[*number] = PartPath(path, *number);
  }
  return parts;
}

// A recorder locks the part it writes, for as long as it lives.
bool IsBeingWritten(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  errno = EBUSY;
  return locked;
}

}  // namespace

CaptureFiles::CaptureFiles(CaptureOptions options, FleetCapture::QosOf qos)
    : options_(std::move(options)), qos_(std::move(qos)) {}

CaptureFiles::~CaptureFiles() {
  if (file_ >= 0) ::close(file_);
}

bool CaptureFiles::Fail(const std::string& what) {
  if (fault_.empty()) fault_ = fmt::format("{}: {}: {}", part_path_, what, std::strerror(errno));
  return false;
}

bool CaptureFiles::Append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return Fail("cannot be written; the recording ends here");
    bytes.remove_prefix(static_cast<std::size_t>(written));
    bytes_ += static_cast<std::uint64_t>(written);
  }
  return true;
}

// A recorder that was restarted continues after the parts that are there, and they count as kept.
bool CaptureFiles::FindEarlierParts() {
  for (const auto& [number, path] : PartsOf(options_.path)) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    closed_.emplace_back(path, error ? 0 : size);
    part_ = earlier_parts_ = number;
    part_path_ = path;
  }
  return closed_.empty() || !IsBeingWritten(part_path_) || Fail("another recorder writes it");
}

bool CaptureFiles::Open(SteadyTime now) {
  if (part_ == 0 && HasParts() && !FindEarlierParts()) return false;
  ++part_;
  part_path_ = HasParts() || part_ > 1 ? PartPath(options_.path, part_) : options_.path;
  // An existing file is another recording.
  constexpr mode_t kMode = 0644;
  file_ = ::open(part_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
  if (file_ < 0) return Fail("cannot be made");
  ::flock(file_, LOCK_EX | LOCK_NB);  // a file system without locks records all the same
  opened_ = now;
  capture_ = std::make_unique<FleetCapture>(
      [this](std::string_view bytes) { return Append(bytes); }, qos_, options_.profile);
  return fault_.empty();
}

bool CaptureFiles::Start(SteadyTime now) { return part_ > 0 ? fault_.empty() : Open(now); }

// Of what may be kept, one part takes half at most: then there is always an older one to remove.
bool CaptureFiles::IsPartFull(SteadyTime now) const {
  if (capture_->Chunks() >= options_.most_chunks) return true;
  if (options_.split_time.count() != 0 && now - opened_ >= options_.split_time) return true;
  if (options_.split_bytes != 0 && capture_->Size() >= options_.split_bytes) return true;
  return options_.keep_bytes != 0 && capture_->Size() >= options_.keep_bytes / 2;
}

template <typename Sample>
bool CaptureFiles::WriteNewest(const Sample& sample, std::uint64_t log_ns, SteadyTime now) {
  if (!fault_.empty()) return false;
  if (capture_ != nullptr && IsPartFull(now) && !ClosePart()) return false;
  if (capture_ == nullptr && !Open(now)) return false;
  ++messages_;
  newest_ns_ = std::max(newest_ns_, log_ns);
  const bool written = capture_->Write(sample);
  RemoveOldest();
  return written;
}

bool CaptureFiles::Write(const link::RawSample& sample, SteadyTime now) {
  return WriteNewest(sample, sample.reception_ns, now);
}
bool CaptureFiles::Write(const Ros2Sample& sample, SteadyTime now) {
  return WriteNewest(sample, sample.log_ns, now);
}

bool CaptureFiles::Flush() { return fault_.empty() && (capture_ == nullptr || capture_->Flush()); }

bool CaptureFiles::ClosePart() {
  const bool whole = capture_->Close();
  closed_.emplace_back(part_path_, capture_->Size());
  capture_.reset();
  if (::close(file_) != 0) Fail("cannot be closed");
  file_ = -1;
  RemoveOldest();
  return whole && fault_.empty();
}

void CaptureFiles::RemoveOldest() {
  if (options_.keep_bytes == 0) return;
  std::uint64_t total = capture_ == nullptr ? 0 : capture_->Size();
  for (const auto& [path, size] : closed_) total += size;
  const std::size_t newest = capture_ == nullptr ? 1 : 0;  // of closed_, and stays
  while (closed_.size() > newest && total > options_.keep_bytes) {
    total -= closed_.front().second;
    ::unlink(closed_.front().first.c_str());
    closed_.pop_front();
  }
}

// One that cannot be read is said, and the recording is whole without it.
void CaptureFiles::Attach(const std::string& path) {
  const std::optional<std::string> bytes = ReadWholeFile(path);
  if (!bytes) {
    missing_ += (missing_.empty() ? "" : ", ") + path;
    return;
  }
  capture_->Attach(path.substr(path.rfind('/') + 1), *bytes, newest_ns_);
}

void CaptureFiles::AttachAtEnd(const std::vector<std::string>& files) {
  options_.attachments.insert(options_.attachments.end(), files.begin(), files.end());
}

bool CaptureFiles::Close() {
  if (!Start(SteadyTime{0})) return false;
  if (capture_ == nullptr) return fault_.empty();
  for (const std::string& path : options_.attachments) Attach(path);
  return ClosePart();
}

void CaptureFiles::Discard() {
  capture_.reset();
  if (file_ >= 0) {
    ::unlink(part_path_.c_str());
    ::close(file_);
    file_ = -1;
  }
  for (const auto& [path, size] : closed_) {
    if (NumberOfPart(options_.path, path).value_or(1) > earlier_parts_) ::unlink(path.c_str());
  }
  closed_.clear();
}

}  // namespace giveway
