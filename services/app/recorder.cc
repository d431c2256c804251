#include "services/app/recorder.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "services/app/framed_stream.h"
#include "services/app/process.h"
#include "services/app/recording.h"
#include "services/app/slot_ring.h"

namespace giveway::app {
namespace {

constexpr std::size_t kSlots = 128;  // 6.4 s of steps at 20 Hz
static_assert((kSlots & (kSlots - 1)) == 0, "a power of two");

int OpenAnew(const std::string& file) {
  std::error_code none;
  if (std::filesystem::is_regular_file(file, none)) {
    std::filesystem::rename(file, file + ".old", none);
  }
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd >= 0) return fd;
  throw std::runtime_error("--record " + file + ": cannot be written: " + std::strerror(errno) +
                           "; name a file in a folder that exists and is yours to write");
}

}  // namespace

// The recorder's thread and its file.
class Recorder::Writer {
 public:
  explicit Writer(const std::string& file)
      : file_(file), fd_(OpenAnew(file)), ring_(kSlots), thread_([this] { Run(); }) {}
  ~Writer() {
    Finish();
    ::close(fd_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  SlotRing<Record>& Ring() { return ring_; }
  bool HasFailed() const { return failed_.load(std::memory_order_acquire); }
  const std::string& File() const { return file_; }

  // Waits until everything queued is written.
  void Finish() {
    if (!thread_.joinable()) return;
    ring_.Close();
    thread_.join();
  }
  // Steps in the file; after Finish.
  std::uint32_t Steps() const { return steps_; }
  void WriteEnd(const RecordedEnd& end) { Write(Framed(ToBytes(end))); }

 private:
  void Run() {
    Write(kRecordingMark);
    while (const Record* record = ring_.Next()) {
      Write(Framed(ToBytes(*record)));
      if (!HasFailed() && std::holds_alternative<RecordedStep>(*record)) ++steps_;
      ring_.Pop();
    }
  }

  void Write(std::string_view bytes) {
    while (!HasFailed() && !bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written >= 0) {
        bytes.remove_prefix(static_cast<std::size_t>(written));
      } else if (errno != EINTR) {
        LogError("the recording " + file_ + " ends here: " + std::strerror(errno));
        failed_.store(true, std::memory_order_release);
      }
    }
  }

  const std::string file_;
  const int fd_;
  SlotRing<Record> ring_;
  std::atomic<bool> failed_{false};
  std::uint32_t steps_ = 0;
  std::thread thread_;  // last: it uses all of the above
};

Recorder::Recorder(const std::string& file) : writer_(std::make_unique<Writer>(file)) {}

Recorder::~Recorder() { Close(); }

// True if it was queued. `fill` makes the record in a slot that may hold an older one.
template <typename Fill>
bool Recorder::Queue(Fill&& fill) {
  Record* const slot = ended_ || writer_->HasFailed() ? nullptr : writer_->Ring().Free();
  if (slot != nullptr) {
    fill(slot);
    writer_->Ring().Push();
    return true;
  }
  if (!ended_ && !writer_->HasFailed()) {
    LogWarning("the recording " + writer_->File() + " ends here: the disk does not keep up");
  }
  ended_ = true;
  return false;
}

void Recorder::Begin(const VehicleOptions& options, std::uint32_t boot_epoch) {
  Queue([&](Record* slot) { *slot = RecordedLife{boot_epoch, options, GIVEWAY_VERSION}; });
}

void Recorder::Reseat(const VehicleOptions& options) {
  Queue([&](Record* slot) { *slot = RecordedReseat{options}; });
}

void Recorder::Step(const Inputs& inputs, const Outputs& outputs, std::uint64_t hash) {
  const bool queued = Queue([&](Record* slot) {
    auto* step = std::get_if<RecordedStep>(slot);
    if (step == nullptr) step = &slot->emplace<RecordedStep>();
    step->Hold(inputs, outputs, hash);
  });
  ++(queued ? tally_.steps : tally_.lost);
}

RecorderTally Recorder::Close() {
  if (closed_) return tally_;
  closed_ = true;
  writer_->Finish();
  tally_.lost += tally_.steps - writer_->Steps();
  tally_.steps = writer_->Steps();
  writer_->WriteEnd({tally_.steps, tally_.lost});
  const std::string text =
      "recorded " + std::to_string(tally_.steps) + " steps in " + writer_->File();
  if (tally_.lost == 0 && !writer_->HasFailed()) {
    LogInfo(text);
  } else {
    LogWarning(text + "; " + std::to_string(tally_.lost) + " were lost");
  }
  return tally_;
}

}  // namespace giveway::app
