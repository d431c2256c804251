#include "services/recording/recorder.h"

#include <atomic>
#include <string>
#include <thread>
#include <utility>

#include "services/recording/recording.h"
#include "services/recording/recording_writer.h"
#include "services/runtime/process.h"
#include "services/runtime/slot_ring.h"

namespace giveway {
namespace {

constexpr std::size_t kSlots = 128;  // 6.4 s of steps at 20 Hz
static_assert((kSlots & (kSlots - 1)) == 0, "a power of two");
constexpr Nanoseconds kReportPeriod = std::chrono::minutes(1);
constexpr const char* kTooSlow = "the disk does not keep up";

}  // namespace

// What is to be written, and whether what is there is to be kept first.
struct Recorder::Queued {
  Record record;
  bool keeps = false;
};

// The recorder's thread and its files.
class Recorder::Writer {
 public:
  Writer(const std::string& file, const RecorderOptions& options)
      : files_(file, options.split_bytes, options.ring > Nanoseconds{0}),
        ring_(kSlots),
        thread_([this] { Run(); }) {}
  ~Writer() { Finish(); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  SlotRing<Queued>& Ring() { return ring_; }
  bool HasFailed() const { return failed_.load(std::memory_order_acquire); }
  const std::string& FirstName() const { return files_.FirstName(); }
  // Does not change any more once HasFailed.
  std::string Failure() const { return files_.Failure(); }

  // Waits until everything queued is written.
  void Finish() {
    if (!thread_.joinable()) return;
    ring_.Close();
    thread_.join();
  }
  // After Finish.
  RecordingWriter& Files() { return files_; }

 private:
  void Run() {
    if (!files_.Failure().empty()) failed_.store(true, std::memory_order_release);
    while (const Queued* queued = ring_.Next()) {
      if (queued->keeps) files_.Keep();
      if (!files_.Write(queued->record)) failed_.store(true, std::memory_order_release);
      ring_.Pop();
    }
  }

  RecordingWriter files_;
  SlotRing<Queued> ring_;
  std::atomic<bool> failed_{false};
  std::thread thread_;  // last: it uses all of the above
};

Recorder::Recorder(const std::string& file, const RecorderOptions& options)
    : options_(options), writer_(std::make_unique<Writer>(file, options)) {
  if (writer_->FirstName() != file) {
    LogInfo("records in " + writer_->FirstName() + ": " + file + " is there already");
  }
}

Recorder::~Recorder() { Close(); }

// True if it was queued. `fill` makes the record in a slot that may hold an older one.
template <typename Fill>
bool Recorder::Queue(Fill&& fill) {
  Queued* const slot = ended_ || writer_->HasFailed() ? nullptr : writer_->Ring().Free();
  if (slot != nullptr) {
    fill(&slot->record);
    slot->keeps = std::exchange(keeps_next_, false);
    writer_->Ring().Push();
    return true;
  }
  ended_ = true;
  return false;
}

void Recorder::ReportLoss() {
  const SteadyTime now = SteadyNow();
  if (now < next_report_) return;
  const std::string why =
      writer_->HasFailed() ? writer_->Failure() : writer_->FirstName() + ": " + kTooSlow;
  if (next_report_ == SteadyTime{0}) {
    LogError("the recording ends here: " + why);
  } else {
    LogWarning("the recording has ended: " + why + "; " + std::to_string(tally_.lost) +
               " steps lost so far");
  }
  next_report_ = now + kReportPeriod;
}

void Recorder::Begin(const VehicleOptions& options, std::uint32_t boot_epoch,
                     const std::optional<Handover>& handover) {
  drives_by_ = options;
  Queue([&](Record* slot) {
    *slot = RecordedLife{boot_epoch, options, GIVEWAY_VERSION, handover};
  });
}

void Recorder::Reseat(const VehicleOptions& options) {
  drives_by_ = options;
  Queue([&](Record* slot) { *slot = RecordedReseat{options}; });
}

void Recorder::Step(const Inputs& inputs, const Outputs& outputs, std::uint64_t hash) {
  const bool queued = Queue([&](Record* slot) {
    auto* step = std::get_if<RecordedStep>(slot);
    if (step == nullptr) step = &slot->emplace<RecordedStep>();
    step->Hold(inputs, outputs, hash);
  });
  ++(queued ? tally_.steps : tally_.lost);
  if (!queued) ReportLoss();
}

bool Recorder::WantsImage(SteadyTime now) const {
  return options_.ring > Nanoseconds{0} && !ended_ && now >= image_due_;
}

// The first one falls due with the first step: it says nothing new then, and sets the time.
void Recorder::Image(std::string state, std::uint64_t hash, SteadyTime now) {
  const bool is_first = image_due_ == SteadyTime{0};
  image_due_ = now + options_.ring;
  if (is_first) return;
  Queue([&](Record* slot) {
    *slot = RecordedImage{drives_by_, GIVEWAY_VERSION, std::move(state), hash};
  });
}

bool Recorder::Keep() {
  if (options_.ring == Nanoseconds{0} || ended_ || kept_ == kMostKept) return false;
  ++kept_;
  keeps_next_ = true;
  return true;
}

RecorderTally Recorder::Close() {
  if (closed_) return tally_;
  closed_ = true;
  writer_->Finish();
  RecordingWriter& files = writer_->Files();
  const std::uint32_t given = tally_.steps + tally_.lost;
  files.End(given - files.Steps(), tally_.lost > 0 ? kTooSlow : "");
  tally_ = {.steps = files.Steps(), .lost = given - files.Steps()};
  std::string text = "recorded " + std::to_string(tally_.steps) + " steps in " + files.FirstName();
  if (files.Parts() > 1) text += " and " + std::to_string(files.Parts() - 1) + " further parts";
  if (tally_.lost == 0 && files.Failure().empty()) {
    LogInfo(text);
  } else {
    const std::string why = files.Failure().empty() ? kTooSlow : files.Failure();
    LogError(text + "; " + std::to_string(tally_.lost) + " steps were lost: " + why);
  }
  return tally_;
}

}  // namespace giveway
