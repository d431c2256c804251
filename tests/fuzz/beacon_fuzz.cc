// Any bytes as beacons: the brain accepts or refuses each, counts it once, and stays sane.
//
// An input is one byte for the behaviour and then records; Bit says what a record's first byte
// means.
#include <array>
#include <vector>

#include "services/link/convert/convert.h"
#include "services/types/check.h"
#include "tests/fuzz/outputs.h"
#include "tests/fuzz/wire_bytes.h"
#include "tests/support/brain_bench.h"

namespace giveway::fuzz {
namespace {

enum Bit : unsigned {
  kSealed,     // the checksum is recomputed: else no mutated beacon would pass it
  kNamed,      // the writer's partition names the id the beacon claims
  kRival,      // another writer
  kSteps,      // the brain steps after this one; else more beacons come in the same drain
  kEcho,       // something is heard ahead
  kBlind,      // no scan comes with this step
  kLate,       // 300 ms pass, and not 50
  kSecondLife  // a third writer
};

class Session {
 public:
  explicit Session(Behaviour behaviour) : options_(OptionsOf(behaviour)), brain_(options_, 42) {}

  // Passes a sample through the inbox of services/link.
  void Hear(const Record& record) {
    wire::Beacon sample;
    if (!Deserialize(record.sample, &sample)) return;
    Beacon beacon;
    link::Arrival arrival = link::FromWire(sample, beacon);
    if (record.Says(kSealed) && arrival.readable) arrival.crc_valid = true;
    if (arrival.crc_valid && !arrival.readable) return;
    heard_.push_back({.beacon = beacon,
                      .received = now_,
                      .crc_valid = arrival.crc_valid,
                      .name_valid = record.Says(kNamed),
                      .writer = 1U + record.Says(kRival) + 2U * record.Says(kSecondLife)});
  }

  void Step(const Record& record) {
    const BeaconCounters before = brain_.State().counters.beacons;
    now_ += std::chrono::milliseconds(record.Says(kLate) ? 300 : 50);
    Inputs inputs{.now = now_, .beacons = heard_};
    if (!record.Says(kBlind)) {
      inputs.scan = test::ClearScan(++tick_);
      if (record.Says(kEcho)) test::SetEcho(&*inputs.scan, 3, 1.5 - 0.01 * (tick_ % 100));
    }
    const Outputs outputs = brain_.Step(inputs);
    CheckOutputs(outputs, options_);
    CheckCounters(before);
    GIVEWAY_CHECK(outputs.beacon.tick == kNoTick || IsInRange(outputs.beacon));
    heard_.clear();
  }

 private:
  static VehicleOptions OptionsOf(Behaviour behaviour) {
    VehicleOptions options = test::DefaultOptions();
    options.behaviour = behaviour;
    options.ageing_limit = std::chrono::milliseconds(200);
    return options;
  }

  void CheckCounters(const BeaconCounters& before) const {
    const BeaconCounters& now = brain_.State().counters.beacons;
    GIVEWAY_CHECK(now.taken == before.taken + heard_.size(), now.taken, before.taken);
    GIVEWAY_CHECK(now.taken == now.accepted + now.not_heard + now.Rejected(), now.taken,
                  now.accepted, now.not_heard, now.Rejected());
    GIVEWAY_CHECK(brain_.PeersHeard() <= brain_.State().heard.peers.Peers().size());
  }

  VehicleOptions options_;
  Vehicle brain_;
  SteadyTime now_{0};
  std::uint32_t tick_ = 0;
  std::vector<ReceivedBeacon> heard_;
};

void Append(Input* input, unsigned how, const Beacon& beacon) {
  *input += static_cast<char>(how);
  *input += Serialized(link::ToWire(beacon));
}

constexpr unsigned On(Bit bit) { return 1U << bit; }

// A vehicle crosses ahead: 20 ticks of it.
Input Crossing(Behaviour behaviour, unsigned how) {
  Input input(1, static_cast<char>(behaviour));
  for (std::uint32_t tick = 1; tick <= 20; ++tick) {
    Beacon beacon =
        test::BeaconOf(2, tick, {{1.5, 1.5 - 0.015 * tick}, -kPi / 2}, 0.1 + 0.2 * (how & 1U));
    beacon.wheels = {3, 3};
    if (tick == 20) beacon.mode = Mode::kLeaving;
    Append(&input, how | On(kSteps), beacon);
  }
  return input;
}

// Many vehicles in one drain, some standing and granting.
Input Crowd() {
  Input input(1, '\0');
  for (std::uint32_t tick = 1; tick <= 3; ++tick) {
    for (std::uint32_t id = 2; id <= 8; ++id) {
      Beacon beacon = test::BeaconOf(id, tick, {{0.6 * id, -1.0 + 0.3 * id}, 0.7 * id - 3}, 0.3);
      if (id % 2 == 0) beacon.gives_way_to = VehicleId{1};
      if (id % 3 == 0) beacon.rule = Rule::kArrived;
      Append(&input, On(kSealed) | On(kNamed) | (id == 8 ? On(kSteps) : 0), beacon);
    }
  }
  return input;
}

}  // namespace

std::vector<Input> Samples() {
  std::vector<Input> samples{Crowd()};
  constexpr unsigned kSound = On(kSealed) | On(kNamed);
  for (const Behaviour behaviour :
       {Behaviour::kCooperative, Behaviour::kLectureYield, Behaviour::kLecturePrinted}) {
    samples.push_back(Crossing(behaviour, kSound));
    samples.push_back(Crossing(behaviour, On(kNamed)));
    samples.push_back(Crossing(behaviour, kSound | On(kEcho)));
  }
  samples.push_back(Crossing(Behaviour::kLectureAvoid, kSound | On(kEcho)));
  return samples;
}

}  // namespace giveway::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace giveway;
  if (size == 0) return 0;
  fuzz::Session session(static_cast<Behaviour>(data[0] % kBehaviourCount));
  fuzz::ByteSpan bytes(data + 1, size - 1);
  while (!bytes.empty()) {
    const fuzz::Record record = fuzz::NextRecord<wire::Beacon>(&bytes);
    session.Hear(record);
    if (record.Says(fuzz::kSteps) || bytes.empty()) session.Step(record);
  }
  return 0;
}
