// Replays a recording through a new brain and compares, step by step and bit by bit. Pure except
// for the streams it reads.
#pragma once

#include <cstdint>
#include <functional>
#include <istream>
#include <optional>
#include <string>

#include "services/recording/recording_file.h"
#include "services/recording/replay_report.h"
#include "services/vehicle/vehicle.h"

namespace giveway::fleetctl {

// Called after every replayed step, the one that differs included.
using ReplayWatcher = std::function<void(const RecordedStep& recorded, const Vehicle& brain,
                                         const Outputs& replayed)>;

// Replays the parts of one recording, in their order.
class Replayer {
 public:
  // Stops at the first difference: what a brain does after it shows nothing more. The caller adds
  // the file's name.
  ReplayedFile Replay(std::istream* part, const ReplayWatcher& watch = {});

 private:
  void Begin(const RecordingFile& file, ReplayedFile* outcome);
  std::string TakeImage(const RecordedImage& image, ReplayedFile* outcome);
  void Lead(RecordingFile* file, const ReplayWatcher& watch, ReplayedFile* outcome);

  std::optional<Vehicle> brain_;  // absent if the parts so far did not replay to their end
  RecordedContinuation next_;     // how the next part must start
};

// Of a recording that is one file.
ReplayedFile Replay(std::istream* recording, const ReplayWatcher& watch = {});

}  // namespace giveway::fleetctl
