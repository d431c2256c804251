#include "services/observer/capture/run_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/link/sample_codec.h"
#include "services/observer/fleet/frame_json.h"
#include "services/observer/fleet/sample_json.h"

namespace giveway {

namespace {

// The page shows durations of hours, not of centuries: sums of such times and periods do not wrap.
constexpr std::uint64_t kLatest_ns = std::uint64_t{1} << 62U;
constexpr Nanoseconds kLongestPeriod = std::chrono::hours(24);

template <typename Parts>
void AppendAll(const Parts& parts, std::string* json) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i != 0) *json += ",\n";
    *json += parts[i].json;
  }
}

}  // namespace

void RunFrames::NoteEvents(const FleetView& view, SteadyTime now) {
  const auto& events = view.Events();
  const std::uint64_t fresh =
      std::min<std::uint64_t>(view.EventCount() - events_noted_, events.size());
  events_noted_ = view.EventCount();
  const auto at_ms = static_cast<std::int64_t>(Milliseconds(now));
  for (std::size_t i = events.size() - fresh; i < events.size(); ++i) {
    if (events_.size() >= kMostEvents) return;
    Json object;
    AddFields(events[i], &object);
    events_.push_back({now, fmt::format("[{},{}]", at_ms, JsonText(std::move(object)))});
  }
}

void RunFrames::Note(const FleetView& view, SteadyTime now) {
  NoteEvents(view, now);
  DropOld(now);
  if (now < due_ || !view.Heard().IsAnyHeard()) return;
  AddFrame(view, now);
}

void RunFrames::NoteLast(const FleetView& view, SteadyTime now) {
  NoteEvents(view, now);
  if (!view.Heard().IsAnyHeard()) return;
  if (!frames_.empty() && frames_.back().at == now) DropLast();  // less was known of it then
  AddFrame(view, now);
}

void RunFrames::AddFrame(const FleetView& view, SteadyTime now) {
  due_ = now + period_;
  frames_.push_back({now, FrameJson(view, now, 0)});
  bytes_ += frames_.back().json.size();
  if (frames_.size() > kMostFrames || bytes_ > kMostBytes) Thin();
}

void RunFrames::DropLast() {
  bytes_ -= frames_.back().json.size();
  frames_.pop_back();
}

void RunFrames::Thin() {
  period_ = std::min(2 * period_, kLongestPeriod);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frames_.size(); i += 2) std::swap(frames_[kept++], frames_[i]);
  frames_.resize(kept);
  bytes_ = 0;
  for (const Noted& frame : frames_) bytes_ += frame.json.size();
}

void RunFrames::DropOld(SteadyTime now) {
  if (last_ == Nanoseconds{0}) return;
  const auto is_old = [&](const Noted& noted) { return now - noted.at > last_; };
  while (!events_.empty() && is_old(events_.front())) events_.pop_front();
  while (!frames_.empty() && is_old(frames_.front())) {
    bytes_ -= frames_.front().json.size();
    frames_.pop_front();
  }
}

std::string RunFrames::RunJson(const std::string& scene, Opens opens) const {
  std::string json = opens == Opens::kReport ? "{\"opens\":\"report\"," : "{\"opens\":\"map\",";
  json += "\"scene\":" + scene + ",\"events\":[";
  AppendAll(events_, &json);
  json += "],\"frames\":[";
  json.reserve(json.size() + bytes_ + 2 * frames_.size() + 2);
  AppendAll(frames_, &json);
  return json + "]}";
}

namespace {

// The recorder's time, which only grows: its system clock may be set back while it records, and
// what follows continues from where it was.
class RunClock {
 public:
  void Hear(std::uint64_t log_ns) {
    const SteadyTime heard{static_cast<std::int64_t>(std::min(log_ns, kLatest_ns))};
    if (now_ - shift_ - heard > kStepBack) shift_ = now_ - heard;
    now_ = std::max(now_, std::min(heard, kLatest - shift_) + shift_);
  }
  SteadyTime Now() const { return now_; }

 private:
  // A recorder that stood still writes what waited topic by topic, a status of seconds ago after a
  // beacon of now: that is no step.
  static constexpr Nanoseconds kStepBack = std::chrono::seconds(10);
  static constexpr SteadyTime kLatest{static_cast<std::int64_t>(kLatest_ns)};

  SteadyTime now_{0};
  Nanoseconds shift_{0};
};

class RunReader {
 public:
  void Take(std::uint64_t log_ns, std::string_view topic, std::string_view sample) {
    clock_.Hear(log_ns);
    if (clock_.Now() - folded_ >= kStep || taken_ >= kMostPending) Fold();
    const link::Decoded decoded = link::DecodeInto(topic, sample, &pending_);
    if (decoded == link::Decoded::kUnreadable) ++run_.unreadable;
    ++taken_;
  }
  RunRead Finish(mcap::ReadResult result) {
    view_.Fold(pending_, clock_.Now());
    run_.frames.NoteLast(view_, clock_.Now());
    run_.result = std::move(result);
    return std::move(run_);
  }

 private:
  static constexpr Nanoseconds kStep = std::chrono::milliseconds(20);
  // Also of one moment no more wait: a file may give all of its samples the same time. Of more
  // events at once a view keeps only the last.
  static constexpr std::size_t kMostPending = FleetView::kMostEvents;

  // What waits came within the step that is over now.
  void Fold() {
    const SteadyTime now = clock_.Now();
    const bool is_step = folded_.count() != 0 && now - folded_ >= kStep;
    view_.Fold(pending_, is_step ? now - kStep : now);
    pending_ = {};
    taken_ = 0;
    run_.frames.Note(view_, now);
    folded_ = now;
  }

  RunRead run_;
  FleetView view_;
  RunClock clock_;
  link::Observed pending_;
  std::size_t taken_ = 0;  // messages since the last fold
  SteadyTime folded_{0};
};

}  // namespace

RunRead ReadRun(const mcap::McapReader::Source& source) {
  RunReader reader;
  mcap::ReadResult result = mcap::McapReader::Read(
      source, [&](const mcap::Message& message, const mcap::Channel& channel, const mcap::Schema&) {
        reader.Take(message.log_ns, channel.topic, message.data);
        return true;
      });
  return reader.Finish(std::move(result));
}

}  // namespace giveway
