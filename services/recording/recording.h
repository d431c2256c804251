// What a vehicle's recording consists of, as values, and their bytes. The format is documented in
// idl/recording.proto; files are recorder.h's and recording_file.h's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "services/types/handover.h"
#include "services/types/vehicle_io.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// The first line of a file; the number counts formats.
inline constexpr std::string_view kRecordingMark = "giveway-recording-3\n";

struct RecordedLife {
  std::uint32_t boot_epoch = 0;
  VehicleOptions options;
  std::string recorded_by;
  std::optional<Handover> handover;
};

struct RecordedReseat {
  VehicleOptions options;
};

// One step, owning what Inputs only points to.
struct RecordedStep {
  SteadyTime now{0};
  std::optional<RangeScan> scan;
  std::vector<ReceivedBeacon> beacons;
  std::vector<QosEvent> events;
  std::optional<RadarScan> radar;
  std::optional<LidarScan> lidar;
  std::optional<CameraScan> camera;
  std::vector<SignalState> signals;
  std::optional<RosterEntry> roster;
  std::optional<PoseFix> pose_fix;
  bool leaving = false;
  bool halting = false;
  Outputs outputs;
  std::uint64_t hash = 0;

  // Takes a copy; allocates nothing once the lists have been as long before.
  void Hold(const Inputs& inputs, const Outputs& said, std::uint64_t state_hash);
  // Points into this.
  Inputs AsInputs() const;
};

// What a part starts with that is not the first of its recording.
struct RecordedContinuation {
  std::uint32_t boot_epoch = 0;  // of the same life as the parts before
  VehicleId vehicle = kNoVehicle;
  std::uint32_t part = 0;  // the first is 1
  std::uint32_t steps_before = 0;

  friend bool operator==(const RecordedContinuation&, const RecordedContinuation&) = default;
};

// Where a ring continues: a whole brain, so that what lies before it need not be kept.
struct RecordedImage {
  VehicleOptions options;  // by which it drives now
  std::string recorded_by;
  std::string state;       // see services/snapshot/brain_state.h
  std::uint64_t hash = 0;  // of the brain
};

struct RecordedEnd {
  std::uint32_t steps = 0;   // written, in this part
  std::uint32_t lost = 0;    // not written
  std::string failure = {};  // why it ends before the vehicle did; empty: it does not
  bool continues = false;    // there is another part
};

using Record = std::variant<RecordedLife, RecordedStep, RecordedReseat, RecordedEnd,
                            RecordedContinuation, RecordedImage>;

std::string ToBytes(const Record& record);
// Nothing where the bytes are no record: not of the schema, an enumerator it is not known, a list
// of the wrong length, a time beyond decades.
std::optional<Record> RecordFrom(std::string_view bytes);

// Empty if a brain can be made of this, else what of it cannot be.
std::string WhyUnusable(const VehicleOptions& options);

// The first field, in the order of the schema, whose bits are not the same.
struct FieldDifference {
  std::string field;  // "command.target.left_rad_s"
  std::string recorded;
  std::string replayed;
};
std::optional<FieldDifference> FirstDifference(const Outputs& recorded, const Outputs& replayed);

}  // namespace giveway
