#include "services/fleetctl/record/record.h"

#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/record/sample_ring.h"
#include "services/observer/ros2/ros2_samples.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr int kNotAllRecorded = 1;
constexpr Nanoseconds kRecordTurn = std::chrono::milliseconds(10);

std::vector<std::size_t> TopicsOf(const RecordOptions& options) {
  std::vector<std::size_t> topics;
  for (const std::string& name : options.topics) topics.push_back(RawTopicNamed(name));
  if (!topics.empty()) return topics;
  for (std::size_t i = 0; i < link::RawTopics().size(); ++i) topics.push_back(i);
  return topics;
}

class Recording {
 public:
  explicit Recording(const RecordOptions& options)
      : options_(options),
        link_(LinkOptionsOf(options.where), TopicsOf(options)),
        files_(options.files, [this](std::size_t topic) { return link_.QosText(topic); }),
        ring_(options.last_s),
        began_(SteadyNow()) {
    if (options.ros2) ros2_.emplace(options.ros2_rate_hz);
  }

  int Run() {
    if (!files_.Start(began_)) {
      std::fprintf(stderr, "%s\n", files_.Fault().c_str());
      return kCouldNotRun;
    }
    SteadyTime flush_at = began_ + kFlushPeriod;
    while (Interrupts::Count() == 0 && !IsOver() && files_.Fault().empty()) {
      SleepUntil(SteadyNow() + kRecordTurn);
      TakeNew();
      if (SteadyNow() < flush_at) continue;
      files_.Flush();
      flush_at = SteadyNow() + kFlushPeriod;
    }
    return Finish();
  }

 private:
  bool IsOver() const {
    return options_.duration_s && Seconds(SteadyNow() - began_) >= *options_.duration_s;
  }

  void TakeNew() {
    const SteadyTime now = SteadyNow();
    link_.Take([&](link::RawSample sample) {
      if (options_.last_s > 0) {
        ring_.Add(std::move(sample), now);
      } else {
        Write(sample, now);
      }
    });
  }

  void Write(const link::RawSample& sample, SteadyTime now) {
    files_.Write(sample, now);
    if (!ros2_) return;
    for (const Ros2Sample& message : ros2_->Take(sample)) files_.Write(message, now);
  }

  int Finish() {
    Interrupts::AllowSeconds(kWriteSeconds);  // of a ring, and of what is attached
    if (options_.last_s > 0) {
      for (const link::RawSample& sample : ring_.Samples()) Write(sample, SteadyTime{0});
      if (ring_.Dropped() > 0) {
        std::fprintf(stderr, "%llu samples were too many for the memory of a ring\n",
                     static_cast<unsigned long long>(ring_.Dropped()));
      }
    }
    const bool whole = files_.Fault().empty() && files_.Close();
    if (!files_.Missing().empty()) {
      std::fprintf(stderr, "cannot be read, and is not attached: %s\n", files_.Missing().c_str());
    }
    if (!files_.Fault().empty()) std::fprintf(stderr, "%s\n", files_.Fault().c_str());
    std::fprintf(stderr, "%s\n",
                 fmt::format("{} samples, {:.1f} MB in {} file{}", files_.Messages(),
                             static_cast<double>(files_.Bytes()) / 1e6, files_.Parts(),
                             files_.Parts() == 1 ? "" : "s")
                     .c_str());
    if (files_.Messages() == 0) {
      std::fprintf(stderr, "nothing was heard: is the fleet in domain %u, on interface %s?\n",
                   options_.where.domain, options_.where.interface.c_str());
    }
    return whole && files_.Messages() > 0 ? 0 : kNotAllRecorded;
  }

  static constexpr unsigned kWriteSeconds = 30;
  const RecordOptions& options_;
  link::RawLink link_;
  CaptureFiles files_;
  SampleRing ring_;
  std::optional<Ros2Samples> ros2_;
  const SteadyTime began_;
};

}  // namespace

int RunRecord(const RecordOptions& options) {
  const Interrupts interrupts;
  return Recording(options).Run();
}

}  // namespace giveway::fleetctl
