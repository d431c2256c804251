#include "services/recording/recording_writer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "services/recording/framed_stream.h"
#include "services/runtime/process.h"

namespace giveway {
namespace {

constexpr std::size_t kStepsKept = 4;       // to be given up for the end; each is longer than it
constexpr std::uint64_t kRoomForEnd = 128;  // in a file that is split

// "tapes/vehicle-2.recording" is "tapes/vehicle-2.3.recording" with the number 3.
std::string Numbered(const std::string& path, std::uint32_t number) {
  if (number == 1) return path;
  const std::filesystem::path whole(path);
  std::string name = whole.stem();
  name += "." + std::to_string(number) + whole.extension().string();
  return whole.parent_path() / name;
}

bool IsSpecial(const std::string& path) {
  struct stat there {};
  return ::stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode) && !S_ISDIR(there.st_mode);
}

}  // namespace

RecordingPart::RecordingPart(std::string name, int descriptor, bool is_regular)
    : name_(std::move(name)), descriptor_(descriptor), is_regular_(is_regular) {}

RecordingPart::RecordingPart(RecordingPart&& other) noexcept
    : name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      is_regular_(other.is_regular_),
      bytes_(other.bytes_),
      steps_(other.steps_),
      last_steps_(std::move(other.last_steps_)) {}

RecordingPart& RecordingPart::operator=(RecordingPart&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(descriptor_, other.descriptor_);
  is_regular_ = other.is_regular_;
  bytes_ = other.bytes_;
  steps_ = other.steps_;
  last_steps_ = std::move(other.last_steps_);
  return *this;
}

RecordingPart::~RecordingPart() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

int RecordingPart::Append(std::string_view bytes, bool is_step) {
  for (std::string_view left = bytes; !left.empty();) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written >= 0) {
      left.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      return errno;
    }
  }
  if (is_step) {
    ++steps_;
    last_steps_.push_back(bytes_);
    if (last_steps_.size() > kStepsKept) last_steps_.pop_front();
  } else {
    last_steps_.clear();  // only what lies behind it can be taken off
  }
  bytes_ += bytes.size();
  return 0;
}

bool RecordingPart::WriteAt(std::uint64_t offset, std::string_view bytes) const {
  const ssize_t written =
      ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
  return written == static_cast<ssize_t>(bytes.size());
}

bool RecordingPart::PutEnd(RecordedEnd end) {
  for (;;) {
    end.steps = steps_;
    const std::string frame = Framed(ToBytes(end));
    const bool fits = WriteAt(bytes_, frame);
    const std::uint64_t whole = bytes_ + (fits ? frame.size() : 0);
    if (::ftruncate(descriptor_, static_cast<off_t>(whole)) != 0 && is_regular_) return false;
    if (fits || last_steps_.empty()) return fits;
    bytes_ = last_steps_.back();
    last_steps_.pop_back();
    --steps_;
    ++end.lost;
  }
}

RecordingWriter::RecordingWriter(const std::string& path, std::uint64_t split_bytes, bool is_ring)
    : path_(path),
      split_bytes_(split_bytes),
      is_ring_(is_ring),
      part_(MakeNext()),
      first_name_(part_.Name()) {
  head_.part = 1;
  const int fault = part_.Append(kRecordingMark, false);
  if (fault != 0) Fail(part_.Name(), std::strerror(fault), 0);
}

RecordingPart RecordingWriter::MakeNext() {
  if (IsSpecial(path_)) {
    const int descriptor = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor >= 0) return {path_, descriptor, false};
  }
  for (;; ++number_) {
    std::string name = Numbered(path_, number_);
    const int descriptor =
        ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (descriptor >= 0) return {std::move(name), descriptor, true};
    if (errno == EEXIST && !std::filesystem::is_directory(name)) continue;
    throw std::runtime_error("--record " + path_ + ": cannot be written: " + std::strerror(errno) +
                             "; name a file in a folder that exists and is yours to write");
  }
}

bool RecordingWriter::Fail(const std::string& file, const std::string& why, std::uint32_t lost) {
  failed_file_ = file;
  failure_ = why;
  part_.PutEnd({.lost = lost, .failure = why});
  return false;
}

// The part that follows is made before this one says that there is one.
bool RecordingWriter::Split() {
  try {
    RecordingPart next = MakeNext();
    const RecordedContinuation head{head_.boot_epoch, head_.vehicle, head_.part + 1, Steps()};
    int fault = next.Append(std::string(kRecordingMark) + Framed(ToBytes(head)), false);
    if (fault == 0) {
      fault = part_.Append(Framed(ToBytes(RecordedEnd{.steps = part_.Steps(), .continues = true})),
                           false);
    }
    if (fault != 0) {
      ::unlink(next.Name().c_str());
      return Fail(next.Name(), std::strerror(fault), 1);
    }
    head_ = head;
    steps_before_ = Steps();
    const std::string before = part_.Name();
    part_ = std::move(next);
    is_ring_ ? MakeRoom(before) : LogInfo("the recording continues in " + part_.Name());
    return true;
  } catch (const std::runtime_error& error) {
    return Fail(part_.Name(), error.what(), 1);
  }
}

// Two parts are left: the one that starts, and `before`, which is full.
void RecordingWriter::MakeRoom(const std::string& before) {
  if (!keeps_part_) removable_.push_back(before);
  keeps_part_ = false;
  for (; removable_.size() > 1; removable_.pop_front()) ::unlink(removable_.front().c_str());
}

void RecordingWriter::Keep() {
  std::string names;
  for (const std::string& name : removable_) names += name + " and ";
  LogInfo("keeps the recording in " + names + part_.Name());
  removable_.clear();
  keeps_part_ = true;
}

bool RecordingWriter::Write(const Record& record) {
  if (!failure_.empty()) return false;
  if (const auto* life = std::get_if<RecordedLife>(&record)) {
    head_.boot_epoch = life->boot_epoch;
    head_.vehicle = life->options.id;
  }
  const bool is_step = std::holds_alternative<RecordedStep>(record);
  const std::string frame = Framed(ToBytes(record));
  const bool is_full = split_bytes_ > 0 && part_.IsRegular() && part_.Steps() > 0 &&
                       part_.Bytes() + frame.size() + kRoomForEnd > split_bytes_;
  const bool is_image = std::holds_alternative<RecordedImage>(record);
  if (is_image && !part_.IsRegular()) return true;  // a pipe is one file
  if ((is_full || is_image) && !Split()) return false;
  const int fault = part_.Append(frame, is_step);
  return fault == 0 || Fail(part_.Name(), std::strerror(fault), is_step ? 1 : 0);
}

void RecordingWriter::End(std::uint32_t lost, const std::string& why) {
  if (failure_.empty()) {
    const RecordedEnd end{.steps = part_.Steps(), .lost = lost, .failure = why};
    const int fault = part_.Append(Framed(ToBytes(end)), false);
    if (fault == 0) return;
    Fail(part_.Name(), std::strerror(fault), lost);
  } else {
    part_.PutEnd({.lost = lost, .failure = failure_});  // more was lost since it was said first
  }
}

}  // namespace giveway
