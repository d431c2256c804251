#include "services/fleetctl/virtual/virtual_mcap.h"

#include <algorithm>
#include <utility>

#include "services/fleetctl/output/output_file.h"
#include "services/link/sample_codec.h"

namespace giveway::fleetctl {
namespace {

// Virtual time starts here, because some tools show a recording from 1970 as having no time.
constexpr std::uint64_t kStart_ns = 1'000'000'000'000'000'000;
constexpr std::uint32_t kTicksAStatus = 4;  // five reports a second at 20 Hz

// What a process would report of itself, as far as a virtual run has it.
VehicleStatus StatusOf(const Outputs& said, double forward_m_s, const RangeScan* scan) {
  VehicleStatus status;
  status.vehicle = said.beacon.vehicle;
  status.epoch = said.beacon.world_epoch;
  status.tick = said.beacon.tick;
  status.decision = said.command.decision;
  status.gives_way_to = said.beacon.gives_way_to;
  status.forward_m_s = forward_m_s;
  if (scan == nullptr) return status;
  for (const RangeReading& reading : scan->readings) {
    if (reading.kind != Echo::kEcho) continue;
    status.nearest_echo_m =
        std::min(status.nearest_echo_m.value_or(reading.range_m), reading.range_m);
  }
  return status;
}

}  // namespace

void CheckRecordable(const std::string& path) { const VirtualRecording removed_again(path); }

VirtualRecording::VirtualRecording(const std::string& path) : files_({.path = path}, {}) {
  if (files_.Start(SteadyTime{0})) return;
  files_.Discard();
  throw OutputError(files_.Fault() +
                    "; name a new file in a folder that exists and is yours to write");
}

VirtualRecording::~VirtualRecording() {
  if (!whole_) files_.Discard();
}

void VirtualRecording::Write(const char* topic, std::string bytes) {
  files_.Write({.topic = RawTopicNamed(topic),
                .source_ns = now_ns_,
                .reception_ns = now_ns_,
                .sequence = ++sequence_,
                .bytes = std::move(bytes)},
               SteadyTime{0});
}

void VirtualRecording::NoteVehicle(const sim::VirtualFleet& fleet, std::size_t index) {
  const Outputs& said = fleet.OutputsOf(index);
  Write("fleet/beacon", link::Encode(said.beacon));
  Write("fleet/motor_command", link::Encode(said.command));
  if (Number(fleet.World().Now()) % kTicksAStatus != 0) return;
  const auto scans = fleet.World().Scans();
  const auto scan = std::ranges::find(scans, said.beacon.vehicle, &RangeScan::vehicle);
  const auto truths = fleet.World().Truths();
  const auto truth = std::ranges::find(truths, said.beacon.vehicle, &Truth::vehicle);
  Write("fleet/status", link::Encode(StatusOf(said, truth == truths.end() ? 0 : truth->forward_m_s,
                                              scan == scans.end() ? nullptr : &*scan)));
}

void VirtualRecording::Note(const sim::VirtualFleet& fleet) {
  const sim::Run& world = fleet.World();
  const auto period_ns = static_cast<std::uint64_t>(fleet.TheScenario().tick_period.count());
  now_ns_ = kStart_ns + Number(world.Now()) * period_ns;
  for (const WorldEvent& event : world.Events()) Write("world/event", link::Encode(event));
  for (const Truth& truth : world.Truths()) Write("world/truth", link::Encode(truth));
  for (const RangeScan& scan : world.Scans()) Write("world/ranges", link::Encode(scan));
  for (const SignalState& signal : world.Signals()) Write("world/signal", link::Encode(signal));
  for (std::size_t i = 0; i < fleet.Size(); ++i) {
    if (fleet.Answered(i)) NoteVehicle(fleet, i);
  }
  if (world.State() == RunState::kEnded) Write("world/figures", link::Encode(world.Figures()));
}

void VirtualRecording::Close() {
  if (!files_.Close() || !files_.Fault().empty()) throw OutputError(files_.Fault());
  whole_ = true;
}

}  // namespace giveway::fleetctl
