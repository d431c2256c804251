// A recorded run as the page shows it: the file's samples decoded, folded as an observer folds
// them, a frame every tenth of a second.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "services/mcap/mcap_reader.h"
#include "services/observer/fleet/fleet_view.h"

namespace giveway {

// Collects frames and events of a run in progress. Bounded: in a longer run every second frame is
// dropped; of more events the first stay. Or the last of a run without an end.
class RunFrames {
 public:
  static constexpr std::size_t kMostFrames = 6000;  // ten minutes at ten a second
  static constexpr std::uint64_t kMostBytes = 256ULL << 20U;
  static constexpr std::size_t kMostEvents = 50'000;
  enum class Opens : std::uint8_t { kMap, kReport };  // what the page shows first

  RunFrames() = default;
  // Drops what is older than this. Five frames a second: most of them are never looked at.
  explicit RunFrames(Nanoseconds last) : last_(last), period_(2 * kTenth) {}

  // Takes the events that came since the last call, and a frame if one is due.
  void Note(const FleetView& view, SteadyTime now);
  // The same at the end of a run: its last moment is a frame, due or not.
  void NoteLast(const FleetView& view, SteadyTime now);
  std::size_t Size() const { return frames_.size(); }
  // {"opens":"map","scene":…,"events":[[at_ms,{…}],…],"frames":[…]}, for PageWithRun.
  std::string RunJson(const std::string& scene, Opens opens = Opens::kMap) const;

 private:
  struct Noted {
    SteadyTime at{0};
    std::string json;
  };
  void NoteEvents(const FleetView& view, SteadyTime now);
  void AddFrame(const FleetView& view, SteadyTime now);
  void DropLast();
  void Thin();
  void DropOld(SteadyTime now);

  static constexpr Nanoseconds kTenth{100'000'000};

  Nanoseconds last_{0};  // 0: all of it
  std::deque<Noted> frames_;
  std::uint64_t bytes_ = 0;  // of frames_
  std::deque<Noted> events_;
  std::uint64_t events_noted_ = 0;
  Nanoseconds period_{kTenth};
  SteadyTime due_{0};
};

struct RunRead {
  RunFrames frames;
  mcap::ReadResult result;
  std::uint64_t unreadable = 0;  // samples of known topics that could not be decoded
};

RunRead ReadRun(const mcap::McapReader::Source& source);

}  // namespace giveway
