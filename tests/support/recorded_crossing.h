// A recording in memory: a brain on the bench meets another at a crossing, as a vehicle's loop
// would have recorded it.
#pragma once

#include <string>
#include <vector>

#include "services/recording/framed_stream.h"
#include "services/recording/recording.h"
#include "tests/support/brain_bench.h"

namespace giveway::test {

// The records of a whole recording: a life, `steps` steps, its end.
inline std::vector<Record> RecordedCrossing(std::uint32_t steps) {
  constexpr std::uint32_t kBoot = 42;
  const VehicleOptions options = DefaultOptions();
  Vehicle brain(options, kBoot);
  std::vector<Record> records{RecordedLife{kBoot, options, "test"}};
  for (std::uint32_t tick = 1; tick <= steps; ++tick) {
    RangeScan scan = ClearScan(tick);
    scan.wheels = {2, 2.25};
    SetEcho(&scan, 3, 2.5 - 0.02 * tick);
    const Pose crosses{{1.5, 1.0 - 0.01 * tick}, -kPi / 2};
    const std::vector<ReceivedBeacon> heard{
        Received(BeaconOf(2, tick, crosses), tick * options.tick_period)};
    const std::vector<QosEvent> events{{.vehicle = VehicleId{2}}};
    Inputs inputs{.now = tick * options.tick_period, .scan = scan, .beacons = heard};
    if (tick == 1) inputs.events = events;
    const Outputs outputs = brain.Step(inputs);
    std::get<RecordedStep>(records.emplace_back(RecordedStep{}))
        .Hold(inputs, outputs, brain.Hash());
  }
  records.emplace_back(RecordedEnd{steps, 0});
  return records;
}

inline std::string FileOf(const std::vector<Record>& records) {
  std::string bytes(kRecordingMark);
  for (const Record& record : records) bytes += Framed(ToBytes(record));
  return bytes;
}

}  // namespace giveway::test
