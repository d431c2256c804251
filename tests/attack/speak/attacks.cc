#include "tests/attack/speak/attacks.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <regex>
#include <thread>

namespace giveway::attack {
namespace {

constexpr std::uint32_t kStrangeEpoch = 0x5eed0001;

// Impersonates the world: sends the target its own entry as modified by `change`.
void SpeakAsWorld(const Orders& orders, const std::function<void(RosterEntry*)>& change) {
  Intruder intruder(orders);
  intruder.LookRound();
  auto roster = intruder.Participant().MakeWriter<wire::Roster>(link::kWorldPartition);
  intruder.AwaitReader(roster);
  intruder.Repeat(milliseconds(50), [&](std::uint32_t i) {
    RosterEntry entry = intruder.Entry();
    entry.epoch = WorldEpoch{kStrangeEpoch + i};
    change(&entry);
    roster.Write(link::ToWire(entry));
  });
}

void RosterOfAnotherId(const Orders& orders) {
  SpeakAsWorld(orders,
               [&](RosterEntry* entry) { entry->vehicle = VehicleId{Number(orders.target) + 1}; });
}

void RosterNan(const Orders& orders) {
  SpeakAsWorld(orders, [](RosterEntry* entry) {
    entry->start_world.position_world.x = std::numeric_limits<double>::quiet_NaN();
  });
}

void RosterFarOff(const Orders& orders) {
  SpeakAsWorld(orders, [](RosterEntry* entry) { entry->start_world.position_world.x += 100; });
}

void RosterEnded(const Orders& orders) {
  SpeakAsWorld(orders, [&](RosterEntry* entry) { entry->run_state = RunState::kEnded; });
}

void RosterRefused(const Orders& orders) {
  SpeakAsWorld(orders, [&](RosterEntry* entry) {
    entry->accepted = false;
    entry->reason = "go away";
  });
}

// Sends leave notices in every vehicle's session, with a join writer of the intruder's.
void Leave(const Orders& orders) {
  Intruder intruder(orders);
  intruder.LookRound();
  auto joins = intruder.Participant().MakeWriter<wire::Join>("fleet");
  intruder.AwaitReader(joins);
  intruder.Repeat(milliseconds(50), [&](std::uint32_t) {
    for (const auto& [vehicle, entry] : intruder.Entries()) {
      joins.Write(
          link::ToWire(JoinRequest{.session = entry.session, .wanted = vehicle, .leaving = true}));
    }
  });
}

// 200 a second, full speed into a spin: of the world's tick and of ticks to come.
void Command(const Orders& orders) {
  Intruder intruder(orders);
  intruder.LookRound();
  auto commands =
      intruder.Participant().MakeWriter<wire::MotorCommand>(link::VehiclePartition(orders.target));
  intruder.AwaitReader(commands);
  intruder.Repeat(milliseconds(5), [&](std::uint32_t i) {
    const Truth& truth = intruder.TargetNow();
    MotorCommand command;
    command.vehicle = orders.target;
    command.epoch = truth.epoch;
    command.tick = After(truth.tick, i % 2 == 0 ? 0 : 1 + i % 4);
    command.target = {6, 6};
    commands.Write(link::ToWire(command));
  });
}

void Scan(const Orders& orders, std::uint32_t ahead, RunState state) {
  Intruder intruder(orders);
  intruder.LookRound();
  auto scans =
      intruder.Participant().MakeWriter<wire::RangeScan>(link::VehiclePartition(orders.target));
  intruder.AwaitReader(scans);
  intruder.Repeat(milliseconds(10), [&](std::uint32_t) {
    const Truth& truth = intruder.TargetNow();
    RangeScan scan;
    scan.vehicle = orders.target;
    scan.epoch = truth.epoch;
    scan.tick = After(truth.tick, ahead);
    scan.run_state = state;
    for (RangeReading& reading : scan.readings) reading = {Echo::kClear, 0, scan.tick, 0};
    scans.Write(link::ToWire(scan));
  });
}

void ScanFarAhead(const Orders& orders) { Scan(orders, 0x8000'0000, RunState::kRunning); }
void ScanEnded(const Orders& orders) { Scan(orders, 1, RunState::kEnded); }

AdminRequest Elsewhere(const Orders& orders) {
  const std::string client =
      "<discovery_config><discoveryProtocol>CLIENT</discoveryProtocol><discoveryServersList>"
      "<RemoteServer prefix=\"44.53.00.5f.45.50.52.4f.53.49.4d.41\"><metatrafficUnicastLocatorList>"
      "<locator><udpv4><address>127.0.0.1</address><port>11999</port></udpv4></locator>"
      "</metatrafficUnicastLocatorList></RemoteServer></discoveryServersList>";
  AdminRequest order{.vehicle = orders.target, .number = 1, .kind = AdminRequestKind::kApply};
  order.profiles.name = "elsewhere.xml";
  order.profiles.text =
      std::regex_replace(OptionsOf(orders).qos.text, std::regex("<discovery_config>"), client);
  return order;
}

void OrderElsewhere(const Orders& orders) {
  Intruder intruder(orders);
  intruder.LookRound();
  auto writer =
      intruder.Participant().MakeWriter<wire::Order>(link::VehiclePartition(orders.target));
  intruder.AwaitReader(writer);
  AdminRequest order = Elsewhere(orders);
  intruder.Repeat(milliseconds(100), [&](std::uint32_t i) {
    order.number = std::uint64_t{1} << 62U | i;
    writer.Write(link::ToWire(order));
  });
}

// Replays what operators sent to the target.
void ReplayOrders(const Orders& orders) {
  Intruder intruder(orders);
  const std::string partition = link::VehiclePartition(orders.target);
  auto writer = intruder.Participant().MakeWriter<wire::Order>(partition);
  intruder.AwaitReader(writer);  // before it has a reader of its own
  auto heard = intruder.Participant().MakeReader<wire::Order>(partition);
  std::vector<wire::Order> kept;
  std::puts("listens");
  std::fflush(stdout);
  intruder.Repeat(milliseconds(20), [&](std::uint32_t i) {
    heard.TakeEach([&](const wire::Order& order, const link::dds::SampleInfo& info) {
      const bool own =
          info.sample_identity.writer_guid().guidPrefix == intruder.Participant().Prefix();
      if (!own) kept.push_back(order);
    });
    if (i % 10 != 0) return;
    for (const wire::Order& order : kept) writer.Write(order);
  });
  std::printf("replayed %zu\n", kept.size());
}

// As fast as they go, for ten seconds at most, and by several writers: the library looks through
// all that a writer has named with each sample that it writes. One command to ten beacons.
void ManyIds(const Orders& orders) {
  constexpr std::uint32_t kIds = 100'000;
  constexpr std::uint32_t kWriters = 20;
  Intruder intruder(orders);
  intruder.LookRound();
  std::vector<link::Writer<wire::Beacon>> beacons;
  std::vector<link::Writer<wire::MotorCommand>> commands;
  for (std::uint32_t i = 0; i < kWriters; ++i) {
    const std::string name = link::VehiclePartition(VehicleId{900 + i});
    beacons.push_back(intruder.Participant().MakeWriter<wire::Beacon>("main/" + name));
    commands.push_back(intruder.Participant().MakeWriter<wire::MotorCommand>(name));
  }
  intruder.AwaitReader(beacons.back());
  intruder.AwaitReader(commands.back());
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  std::uint32_t named = 0;
  for (; named < kIds && std::chrono::steady_clock::now() < give_up; ++named) {
    wire::Beacon beacon;
    beacon.vehicle(1000 + named);
    beacons[named % kWriters].Write(beacon);
    if (named % 10 != 0) continue;
    wire::MotorCommand command;
    command.vehicle(1000 + named);
    commands[named / 10 % kWriters].Write(command);
  }
  std::printf("%u ids\n", named);
}

// From several participants, as fast as they go, for ten seconds at most: where the world does not
// acknowledge them, each blocks for as long as the QoS lets it.
void SybilJoins(const Orders& orders) {
  constexpr std::size_t kParticipants = 10;
  constexpr std::uint32_t kJoins = 30'000;
  Unnamed listener;
  std::vector<std::unique_ptr<link::Participant>> participants;
  std::vector<link::Writer<wire::Join>> writers;
  for (std::size_t i = 0; i < kParticipants; ++i) {
    participants.push_back(
        std::make_unique<link::Participant>(OptionsOf(orders), "sybil", listener));
    writers.push_back(participants.back()->MakeWriter<wire::Join>("fleet"));
  }
  std::this_thread::sleep_for(milliseconds(500));
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  std::uint32_t i = 0;
  for (; i < kJoins && std::chrono::steady_clock::now() < give_up; ++i) {
    const JoinRequest request{.session = {0x5b11, i, i * 7, 1}, .wanted = kNoVehicle};
    writers[i % kParticipants].Write(link::ToWire(request));
    if (i % 500 == 0) std::this_thread::sleep_for(milliseconds(10));
  }
  std::printf("%u joins\n", i);
  std::fflush(stdout);
  std::this_thread::sleep_for(milliseconds(500));
}

}  // namespace

const std::map<std::string, Attack>& Attacks() {
  static const std::map<std::string, Attack> attacks = {{"roster-id", RosterOfAnotherId},
                                                        {"roster-nan", RosterNan},
                                                        {"roster-far", RosterFarOff},
                                                        {"roster-ended", RosterEnded},
                                                        {"roster-refused", RosterRefused},
                                                        {"leave", Leave},
                                                        {"command", Command},
                                                        {"scan-ahead", ScanFarAhead},
                                                        {"scan-ended", ScanEnded},
                                                        {"order", OrderElsewhere},
                                                        {"replay", ReplayOrders},
                                                        {"ids", ManyIds},
                                                        {"sybil", SybilJoins}};
  return attacks;
}

}  // namespace giveway::attack
