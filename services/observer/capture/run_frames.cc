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
  due_ = now + period_;
  frames_.push_back({now, FrameJson(view, now, 0)});
  bytes_ += frames_.back().json.size();
  if (frames_.size() > kMostFrames || bytes_ > kMostBytes) Thin();
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

RunRead ReadRun(const mcap::McapReader::Source& source) {
  RunRead run;
  FleetView view;
  link::Observed pending;
  SteadyTime now{0};
  constexpr Nanoseconds kStep = std::chrono::milliseconds(20);
  SteadyTime folded{0};
  run.result = mcap::McapReader::Read(
      source, [&](const mcap::Message& message, const mcap::Channel& channel, const mcap::Schema&) {
        const SteadyTime at{static_cast<std::int64_t>(std::min(message.log_ns, kLatest_ns))};
        if (at > now) now = at;
        if (now - folded >= kStep) {
          view.Fold(pending, folded.count() == 0 ? now : now - kStep);
          pending = {};
          run.frames.Note(view, now);
          folded = now;
        }
        const link::Decoded decoded = link::DecodeInto(channel.topic, message.data, &pending);
        if (decoded == link::Decoded::kUnreadable) ++run.unreadable;
        return true;
      });
  view.Fold(pending, now);
  run.frames.Note(view, now + std::chrono::seconds(1));
  return run;
}

}  // namespace giveway
