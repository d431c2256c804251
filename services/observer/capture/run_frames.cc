#include "services/observer/capture/run_frames.h"

#include "services/link/sample_codec.h"
#include "services/observer/fleet/frame_json.h"

namespace giveway {

void RunFrames::Note(const FleetView& view, SteadyTime now) {
  if (now < due_ || !view.Heard().Anybody()) return;
  due_ = now + period_;
  frames_.push_back(FrameJson(view, now));
  bytes_ += frames_.back().size();
  if (frames_.size() > kMostFrames || bytes_ > kMostBytes) Thin();
}

void RunFrames::Thin() {
  period_ *= 2;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frames_.size(); i += 2) std::swap(frames_[kept++], frames_[i]);
  frames_.resize(kept);
  bytes_ = 0;
  for (const std::string& frame : frames_) bytes_ += frame.size();
}

std::string RunFrames::RunJson(const std::string& scene) const {
  std::string json = "{\"scene\":" + scene + ",\"frames\":[";
  json.reserve(json.size() + bytes_ + frames_.size() + 16);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (i != 0) json += ",\n";
    json += frames_[i];
  }
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
        const SteadyTime at{static_cast<std::int64_t>(message.log_ns)};
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
