// In lockstep the only clock is the world's tick: a run repeats whatever the machine does, so
// nothing that depends on this machine's clock may come in.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "services/types/vehicle_io.h"

namespace giveway {

class WorldTime {
 public:
  // Puts the world's time into the inputs, which then point into this until the next call. False if
  // there is no new tick: what came, but for events, is held until there is, by copy. Of each
  // sensor and each signal the newest.
  bool Keep(Inputs* inputs, Nanoseconds tick_period);

 private:
  struct Held {
    std::optional<RadarScan> radar;
    std::optional<LidarScan> lidar;
    std::optional<CameraScan> camera;
    std::optional<PoseFix> pose_fix;
    std::vector<SignalState> signals;  // one a head

    void Take(const Inputs& inputs);
    void TakeSignals(std::span<const SignalState> newer);
    // Into inputs, where they have none newer.
    void Give(Inputs* inputs);
  };

  std::vector<ReceivedBeacon> held_;
  std::vector<ReceivedBeacon> now_;
  Held sensed_;
  Held sensed_now_;
};

}  // namespace giveway
