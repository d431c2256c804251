// Any bytes as scans: whatever the world publishes, the wheel commands are numbers within the caps,
// and the same inputs give the same bits again.
//
// An input is one byte for the behaviour and then records; Bit says what a record's first byte
// means.
#include <vector>

#include "services/link/convert/convert.h"
#include "services/types/check.h"
#include "tests/fuzz/outputs.h"
#include "tests/fuzz/wire_bytes.h"
#include "tests/support/brain_bench.h"

namespace giveway::fuzz {
namespace {

enum Bit : unsigned {
  kInTime,  // tick and epoch are corrected: only the readings are corrupted
  kBlind,   // no scan comes with this step
  kLeaves,  // the process was asked to stop
  kLate,    // 200 ms pass, and not 50
  kPeer,    // a beacon comes too
  kAnew     // with kInTime: the world starts a new epoch
};
constexpr unsigned On(Bit bit) { return 1U << bit; }

class Session {
 public:
  explicit Session(Behaviour behaviour) : options_(OptionsOf(behaviour)), brain_(options_, 42) {}

  void Step(const Record& record) {
    now_ += std::chrono::milliseconds(record.Says(kLate) ? 200 : 50);
    Inputs inputs{.now = now_, .leaving = record.Says(kLeaves)};
    if (!record.Says(kBlind)) inputs.scan = Take(record);
    std::vector<ReceivedBeacon> heard;
    if (record.Says(kPeer)) heard.push_back(Crossing());
    inputs.beacons = heard;
    Step(inputs);
  }

  // Scans in good order after whatever came before.
  void Recover() {
    constexpr int kSteps = 4;
    for (int i = 0; i < kSteps; ++i) {
      now_ += options_.tick_period;
      RangeScan scan = test::ClearScan(Number(brain_.State().world.tick) + 1);
      scan.epoch = epoch_;
      Step({.now = now_, .scan = scan});
    }
  }

  const std::vector<std::uint64_t>& Hashes() const { return hashes_; }

 private:
  static VehicleOptions OptionsOf(Behaviour behaviour) {
    VehicleOptions options = test::DefaultOptions();
    options.behaviour = behaviour;
    options.ageing_limit = std::chrono::milliseconds(200);
    return options;
  }

  // Passes a sample through the inbox of services/link.
  std::optional<RangeScan> Take(const Record& record) {
    wire::RangeScan sample;
    RangeScan scan;
    if (!Deserialize(record.sample, &sample) || !link::FromWire(sample, scan) ||
        scan.vehicle != options_.id) {
      return std::nullopt;
    }
    if (!record.Says(kInTime)) {
      only_in_time_ = false;
      return scan;
    }
    if (record.Says(kAnew)) {
      epoch_ = WorldEpoch{Number(epoch_) + 1};
      tick_ = 0;
    }
    scan.epoch = epoch_;
    scan.tick = Tick{++tick_};
    for (RangeReading& reading : scan.readings) reading.tick = scan.tick;
    return scan;
  }

  ReceivedBeacon Crossing() const {
    Beacon beacon =
        test::BeaconOf(2, 1 + static_cast<std::uint32_t>(hashes_.size()), {{1.5, 1.0}, -kPi / 2});
    beacon.wheels = {3, 3};
    beacon.tick = brain_.State().world.tick;
    beacon.world_epoch = epoch_;
    return test::Received(beacon, now_);
  }

  void Step(const Inputs& inputs) {
    const Outputs outputs = brain_.Step(inputs);
    CheckOutputs(outputs, options_);
    // If time itself was not corrupted, peers must be able to accept what this vehicle publishes.
    GIVEWAY_CHECK(!only_in_time_ || outputs.beacon.tick == kNoTick || IsInRange(outputs.beacon));
    GIVEWAY_CHECK(outputs.command.decision.rule != Rule::kRangesStale ||
                  outputs.command.target == WheelSpeeds{});
    hashes_.push_back(brain_.Hash());
  }

  VehicleOptions options_;
  Vehicle brain_;
  SteadyTime now_{0};
  std::uint32_t tick_ = 0;
  WorldEpoch epoch_ = test::kEpoch;
  bool only_in_time_ = true;
  std::vector<std::uint64_t> hashes_;
};

std::vector<std::uint64_t> Drive(ByteSpan bytes) {
  Session session(static_cast<Behaviour>(bytes[0] % 4));
  for (bytes = bytes.subspan(1); !bytes.empty();) {
    session.Step(NextRecord<wire::RangeScan>(&bytes));
  }
  session.Recover();
  return session.Hashes();
}

// Something comes nearer while the vehicle drives.
Input Approach(Behaviour behaviour, unsigned how) {
  Input input(1, static_cast<char>(behaviour));
  for (std::uint32_t tick = 1; tick <= 12; ++tick) {
    RangeScan scan = test::ClearScan(tick);
    scan.wheels = {3, 2.5};
    test::SetEcho(&scan, 3, 1.2 - 0.05 * tick);
    test::SetEcho(&scan, 5, 0.9 - 0.02 * tick);
    input += static_cast<char>(how);
    input += Serialized(link::ToWire(scan));
  }
  return input;
}

}  // namespace

std::vector<Input> Samples() {
  std::vector<Input> samples;
  for (int behaviour = 0; behaviour < 4; ++behaviour) {
    samples.push_back(Approach(static_cast<Behaviour>(behaviour), 0));
    samples.push_back(Approach(static_cast<Behaviour>(behaviour), On(kInTime)));
    samples.push_back(Approach(static_cast<Behaviour>(behaviour), On(kInTime) | On(kPeer)));
  }
  return samples;
}

}  // namespace giveway::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const giveway::fuzz::ByteSpan bytes(data, size);
  GIVEWAY_CHECK(giveway::fuzz::Drive(bytes) == giveway::fuzz::Drive(bytes));
  return 0;
}
