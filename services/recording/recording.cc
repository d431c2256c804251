#include "services/recording/recording.h"

namespace giveway {
namespace {

template <typename T>
std::optional<T> Copy(const T* value) {
  return value == nullptr ? std::nullopt : std::optional<T>(*value);
}

template <typename T>
const T* PointerTo(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

}  // namespace

void RecordedStep::Hold(const Inputs& inputs, const Outputs& said, std::uint64_t state_hash) {
  now = inputs.now;
  scan = inputs.scan;
  beacons.assign(inputs.beacons.begin(), inputs.beacons.end());
  events.assign(inputs.events.begin(), inputs.events.end());
  radar = Copy(inputs.radar);
  lidar = Copy(inputs.lidar);
  camera = Copy(inputs.camera);
  signals.assign(inputs.signals.begin(), inputs.signals.end());
  roster = inputs.roster;
  pose_fix = inputs.pose_fix;
  leaving = inputs.leaving;
  halting = inputs.halting;
  outputs = said;
  hash = state_hash;
}

Inputs RecordedStep::AsInputs() const {
  return {.now = now,
          .scan = scan,
          .beacons = beacons,
          .events = events,
          .radar = PointerTo(radar),
          .lidar = PointerTo(lidar),
          .camera = PointerTo(camera),
          .signals = signals,
          .roster = roster,
          .pose_fix = pose_fix,
          .leaving = leaving,
          .halting = halting};
}

}  // namespace giveway
