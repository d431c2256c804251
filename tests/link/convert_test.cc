// Every type goes to the wire and back unchanged. Each wire sample is also serialized, to include
// the generated code.
#include "services/link/convert/convert.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/sample_codec.h"
#include "tests/link/travel.h"

namespace giveway::link {
namespace {

using test::RoundTrip;
using test::Travelled;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();
constexpr double kHuge = std::numeric_limits<double>::max();
constexpr std::uint32_t kMax = std::numeric_limits<std::uint32_t>::max();

std::uint64_t Bits(double value) { return std::bit_cast<std::uint64_t>(value); }

TEST(Convert, BeaconComesBackBitForBit) {
  Beacon sent;
  sent.vehicle = VehicleId{kMax};
  sent.boot_epoch = 2;
  sent.seq = 3;
  sent.world_epoch = WorldEpoch{4};
  sent.tick = Tick{kMax - 1};
  sent.wheels = {kNan, -kInfinity};
  sent.cruise_m_s = kTiny;
  sent.world_from_body = {{kHuge, -0.0}, -kHuge};
  sent.covariance = {kInfinity, -0.1, kTiny, -kHuge, 0.2, 0.3};
  sent.body_radius_m = 0.4;
  sent.drive = {0.1, 0.5};
  sent.acceleration_m_s2 = 0.7;
  sent.deceleration_m_s2 = 0.9;
  sent.toward_world = {-kHuge, kTiny};
  sent.mode = Mode::kLeaving;
  sent.rule = Rule::kLeaving;
  sent.gives_way_to = VehicleId{5};
  sent.blocked_by = VehicleId{9};
  sent.order = {6, 7, VehicleId{8}};
  const Beacon back = RoundTrip(sent);
  EXPECT_EQ(back.vehicle, sent.vehicle);
  EXPECT_EQ(back.boot_epoch, sent.boot_epoch);
  EXPECT_EQ(back.seq, sent.seq);
  EXPECT_EQ(back.world_epoch, sent.world_epoch);
  EXPECT_EQ(back.tick, sent.tick);
  EXPECT_EQ(Bits(back.wheels.left_rad_s), Bits(kNan));
  EXPECT_EQ(back.wheels.right_rad_s, -kInfinity);
  EXPECT_EQ(back.cruise_m_s, kTiny);
  EXPECT_EQ(back.world_from_body.position_world.x, kHuge);
  EXPECT_EQ(Bits(back.world_from_body.position_world.y), Bits(-0.0));
  EXPECT_EQ(back.world_from_body.heading_rad, -kHuge);
  EXPECT_EQ(back.covariance, sent.covariance);
  EXPECT_EQ(back.body_radius_m, 0.4);
  EXPECT_EQ(back.drive.wheel_radius_m, 0.1);
  EXPECT_EQ(back.drive.axle_m, 0.5);
  EXPECT_EQ(back.acceleration_m_s2, 0.7);
  EXPECT_EQ(back.deceleration_m_s2, 0.9);
  EXPECT_EQ(back.toward_world, sent.toward_world);
  EXPECT_EQ(back.blocked_by, sent.blocked_by);
  EXPECT_EQ(back.mode, sent.mode);
  EXPECT_EQ(back.rule, sent.rule);
  EXPECT_EQ(back.gives_way_to, sent.gives_way_to);
  EXPECT_EQ(back.order, sent.order);
}

TEST(Convert, BeaconStillPassesItsChecksumAfterTheWay) {
  Beacon sent;
  sent.wheels.left_rad_s = kNan;
  Beacon back;
  EXPECT_TRUE(FromWire(Travelled(ToWire(sent)), back).crc_valid);
}

TEST(Convert, ScanComesBackWithEverySensor) {
  RangeScan sent;
  sent.vehicle = VehicleId{1};
  sent.epoch = WorldEpoch{2};
  sent.tick = Tick{3};
  sent.run_state = RunState::kEnded;
  sent.wheels = {-1, kNan};
  sent.counted = {-kTiny, kHuge};
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    sent.readings[i] = {static_cast<Echo>(i % 3), 0.25 * static_cast<double>(i),
                        Tick{static_cast<std::uint32_t>(100 + i)}, 0.001 * static_cast<double>(i)};
  }
  const RangeScan back = RoundTrip(sent);
  EXPECT_EQ(back.vehicle, sent.vehicle);
  EXPECT_EQ(back.epoch, sent.epoch);
  EXPECT_EQ(back.tick, sent.tick);
  EXPECT_EQ(back.run_state, sent.run_state);
  EXPECT_EQ(back.wheels.left_rad_s, -1);
  EXPECT_EQ(Bits(back.wheels.right_rad_s), Bits(kNan));
  EXPECT_EQ(back.counted, sent.counted);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    EXPECT_EQ(back.readings[i].kind, sent.readings[i].kind) << i;
    EXPECT_EQ(back.readings[i].range_m, sent.readings[i].range_m) << i;
    EXPECT_EQ(back.readings[i].tick, sent.readings[i].tick) << i;
    EXPECT_EQ(back.readings[i].fired_before_s, sent.readings[i].fired_before_s) << i;
  }
}

TEST(Convert, CommandComesBack) {
  const MotorCommand sent{
      .vehicle = VehicleId{1},
      .epoch = WorldEpoch{2},
      .tick = Tick{3},
      .target = {kInfinity, -0.5},
      .decision = {Mode::kSensorOnly, Rule::kUnidentifiedMotion, VehicleId{4}, -1, Tick{5}},
      .decision_changed = true,
      .matched_peers = kMax,
      .task = {6, 7}};
  const MotorCommand back = RoundTrip(sent);
  EXPECT_EQ(back.vehicle, sent.vehicle);
  EXPECT_EQ(back.epoch, sent.epoch);
  EXPECT_EQ(back.tick, sent.tick);
  EXPECT_EQ(back.target, sent.target);
  EXPECT_EQ(back.decision, sent.decision);
  EXPECT_TRUE(back.decision_changed);
  EXPECT_TRUE(back.matched_peers == kMax && back.task == sent.task);
}

TEST(Convert, JoinAndRosterComeBack) {
  const JoinRequest join{{1, 2, 3, kMax}, VehicleId{9}, true};
  EXPECT_EQ(RoundTrip(join).session, join.session);
  EXPECT_EQ(RoundTrip(join).wanted, join.wanted);
  EXPECT_TRUE(RoundTrip(join).leaving);

  const RosterEntry sent{.session = {kMax, 0, 1, 2},
                         .vehicle = VehicleId{3},
                         .accepted = true,
                         .waiting = true,
                         .reason = "vehicle 3 is taken",
                         .epoch = WorldEpoch{4},
                         .start_world = {{-1, 2}, 3},
                         .tick = Tick{7},
                         .counted = {-8, 9},
                         .task = {10, 11},
                         .spawn = 6,
                         .run_state = RunState::kRunning,
                         .fleet_size = 5};
  const RosterEntry back = RoundTrip(sent);
  EXPECT_EQ(back.session, sent.session);
  EXPECT_EQ(back.vehicle, sent.vehicle);
  EXPECT_TRUE(back.accepted && back.waiting);
  EXPECT_EQ(back.reason, sent.reason);
  EXPECT_EQ(back.epoch, sent.epoch);
  EXPECT_EQ(back.start_world, sent.start_world);
  EXPECT_TRUE(back.tick == sent.tick && back.counted == sent.counted && back.task == sent.task);
  EXPECT_TRUE(back.spawn == sent.spawn && back.fleet_size == sent.fleet_size);
  EXPECT_EQ(back.run_state, sent.run_state);
}

TEST(Convert, TruthComesBack) {
  const Truth sent{.vehicle = VehicleId{1},
                   .epoch = WorldEpoch{2},
                   .tick = Tick{3},
                   .time_s = -0.05,
                   .world_from_body = {{4, 5}, 6},
                   .wheels = {7, 8},
                   .forward_m_s = 9,
                   .present = false,
                   .arrived = true};
  const Truth back = RoundTrip(sent);
  EXPECT_EQ(back.vehicle, sent.vehicle);
  EXPECT_EQ(back.epoch, sent.epoch);
  EXPECT_EQ(back.tick, sent.tick);
  EXPECT_EQ(back.time_s, sent.time_s);
  EXPECT_EQ(back.world_from_body, sent.world_from_body);
  EXPECT_EQ(back.wheels, sent.wheels);
  EXPECT_EQ(back.forward_m_s, sent.forward_m_s);
  EXPECT_FALSE(back.present);
  EXPECT_TRUE(back.arrived);
}

TEST(Convert, EventComesBackWhateverItsKind) {
  for (int kind = 0; kind <= static_cast<int>(giveway::EventKind::kFaultOver); ++kind) {
    const WorldEvent sent{.seq = 1,
                          .kind = static_cast<giveway::EventKind>(kind),
                          .epoch = WorldEpoch{2},
                          .tick = Tick{3},
                          .time_s = 4,
                          .vehicle = VehicleId{5},
                          .other = VehicleId{6},
                          .position_world = {7, 8},
                          .other_position_world = {9, 10},
                          .value = 11,
                          .text = "kill"};
    const WorldEvent back = RoundTrip(sent);
    EXPECT_EQ(back.seq, sent.seq);
    EXPECT_EQ(back.kind, sent.kind);
    EXPECT_EQ(back.epoch, sent.epoch);
    EXPECT_EQ(back.tick, sent.tick);
    EXPECT_EQ(back.time_s, sent.time_s);
    EXPECT_EQ(back.vehicle, sent.vehicle);
    EXPECT_EQ(back.other, sent.other);
    EXPECT_EQ(back.position_world, sent.position_world);
    EXPECT_EQ(back.other_position_world, sent.other_position_world);
    EXPECT_EQ(back.value, sent.value);
    EXPECT_EQ(back.text, sent.text);
  }
}

TEST(Convert, FiguresComeBackAndAbsentOnesStayAbsent) {
  RunFigures sent;
  sent.epoch = WorldEpoch{1};
  sent.passed = true;
  sent.reason = "expectations_met";
  sent.contacts = 2;
  sent.min_separation_m = 0.0;
  sent.reaction_p99_ms = 100.5;
  sent.reactions = 3;
  sent.ticks = 4;
  sent.tick_overruns = 5;
  sent.state_hash = std::numeric_limits<std::uint64_t>::max();
  const RunFigures back = RoundTrip(sent);
  EXPECT_EQ(back.epoch, sent.epoch);
  EXPECT_TRUE(back.passed);
  EXPECT_EQ(back.reason, sent.reason);
  EXPECT_EQ(back.contacts, sent.contacts);
  EXPECT_EQ(back.min_separation_m, sent.min_separation_m);
  EXPECT_EQ(back.time_to_clear_s, std::nullopt);
  EXPECT_EQ(back.reaction_p50_ms, std::nullopt);
  EXPECT_EQ(back.reaction_p99_ms, sent.reaction_p99_ms);
  EXPECT_EQ(back.reaction_max_ms, std::nullopt);
  EXPECT_EQ(back.reactions, sent.reactions);
  EXPECT_EQ(back.ticks, sent.ticks);
  EXPECT_EQ(back.tick_overruns, sent.tick_overruns);
  EXPECT_EQ(back.state_hash, sent.state_hash);
}

TEST(Convert, StatusComesBackWithEveryCounter) {
  VehicleStatus sent;
  sent.vehicle = VehicleId{1};
  sent.epoch = WorldEpoch{2};
  sent.tick = Tick{3};
  sent.decision = {Mode::kCooperative, Rule::kAvoid, VehicleId{4}, 15, Tick{5}};
  sent.gives_way_to = VehicleId{6};
  sent.forward_m_s = -0.5;
  sent.nearest_echo_m = 0.75;
  sent.peers_heard = 7;
  sent.beacons = {8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21};
  sent.beacons_superseded = 22;
  sent.qos = {23, 24, 25, 26, 27};
  sent.last_deadline_missed = VehicleId{28};
  sent.last_liveliness_lost = VehicleId{29};
  sent.last_event = QosEventKind::kUnmatched;
  sent.last_event_about = VehicleId{30};
  sent.last_rejected_id = 30;
  sent.step_p99_us = 31;
  sent.loop_max_ms = 32;
  sent.beacon_deadline_offered_ms = 33;
  sent.beacon_deadline_requested_ms = 34;
  sent.beacon_lease_ms = 35;
  sent.trust = {36, 37, 38, 39, 40};
  sent.final = true;
  for (std::uint32_t i = 0; i < kDriveFigures; ++i) {
    sent.timing.figures[i] = {
        .count = 60 + i, .sum = 70.0 + i, .p50 = 80 + i, .p99 = 90 + i, .max = 100 + i};
    sent.timing.figures[i].newest[15] = 110 + i;
  }
  sent.timing.narrowest = ReactionMargin{Tick{120}, 0.25, 0.5};
  sent.timing.budget_spent = 121;
  sent.timing.received_before_sent = 122;
  sent.impaired = {.packets = 41,
                   .passed = 42,
                   .dropped_blackout = 43,
                   .dropped_rate = 44,
                   .dropped_loss = 45,
                   .dropped_burst = 46,
                   .delayed = 47,
                   .held_back = 48,
                   .duplicated = 49,
                   .corrupted = 50,
                   .metered = 51};
  for (std::size_t i = 0; i < kPacketDrops; ++i) sent.packets.packets[i] = 130 + i;
  sent.refused = {150, 151, 152, 153, 154, 155};
  sent.departed = {160, 161, 162, 163, 164, 165, 166};
  for (std::uint32_t i = 0; i < ReportedAccounts::kMost; ++i) {
    sent.accounts.Add({VehicleId{170 + i}, 171 + i, 172, 173, 174, 175, 176, 177, 178 + i});
  }
  sent.heap_bytes = 1ULL << 40U;
  const VehicleStatus back = RoundTrip(sent);
  EXPECT_EQ(back.packets, sent.packets);
  EXPECT_EQ(back.refused, sent.refused);
  EXPECT_EQ(back.departed, sent.departed);
  EXPECT_EQ(back.accounts, sent.accounts);
  EXPECT_EQ(back.heap_bytes, sent.heap_bytes);
  EXPECT_EQ(RoundTrip(VehicleStatus{}).heap_bytes, std::nullopt);
  EXPECT_EQ(back.vehicle, sent.vehicle);
  EXPECT_EQ(back.epoch, sent.epoch);
  EXPECT_EQ(back.tick, sent.tick);
  EXPECT_EQ(back.decision, sent.decision);
  EXPECT_EQ(back.gives_way_to, sent.gives_way_to);
  EXPECT_EQ(back.forward_m_s, sent.forward_m_s);
  EXPECT_EQ(back.nearest_echo_m, sent.nearest_echo_m);
  EXPECT_EQ(back.peers_heard, sent.peers_heard);
  static_assert(sizeof(BeaconCounters) == 14 * 4 && sizeof(QosCounters) == 5 * 4);
  using Counts = std::array<std::uint32_t, 14>;
  EXPECT_EQ(std::bit_cast<Counts>(back.beacons), std::bit_cast<Counts>(sent.beacons));
  static_assert(sizeof(TrustCounters) == 5 * 4);
  using Five = std::array<std::uint32_t, 5>;
  EXPECT_EQ(std::bit_cast<Five>(back.qos), std::bit_cast<Five>(sent.qos));
  EXPECT_EQ(std::bit_cast<Five>(back.trust), std::bit_cast<Five>(sent.trust));
  EXPECT_EQ(back.beacons_superseded, sent.beacons_superseded);
  EXPECT_EQ(back.last_deadline_missed, sent.last_deadline_missed);
  EXPECT_EQ(back.last_liveliness_lost, sent.last_liveliness_lost);
  EXPECT_EQ(back.last_event, sent.last_event);
  EXPECT_EQ(back.last_event_about, sent.last_event_about);
  EXPECT_EQ(back.last_rejected_id, sent.last_rejected_id);
  EXPECT_EQ(back.step_p99_us, sent.step_p99_us);
  EXPECT_EQ(back.loop_max_ms, sent.loop_max_ms);
  EXPECT_EQ(back.beacon_deadline_offered_ms, sent.beacon_deadline_offered_ms);
  EXPECT_EQ(back.beacon_deadline_requested_ms, sent.beacon_deadline_requested_ms);
  EXPECT_EQ(back.beacon_lease_ms, sent.beacon_lease_ms);
  EXPECT_TRUE(back.final);
  EXPECT_EQ(back.timing, sent.timing);
  const auto travels = [](const ImpairmentCounters& c) {
    return std::array{c.packets,      c.passed,        c.dropped_blackout, c.dropped_rate,
                      c.dropped_loss, c.dropped_burst, c.delayed,          c.held_back,
                      c.duplicated,   c.corrupted,     c.metered};
  };
  EXPECT_EQ(travels(back.impaired), travels(sent.impaired));
}

// As earlier writers wrote them and earlier readers read them: without the counts of packets and
// refused samples, or without the heap alone.
class StatusOfBefore : public ::testing::Test {
 protected:
  // Serialized by this release.
  static std::string Bytes(const VehicleStatus& status) { return Encode(status); }
  static std::optional<VehicleStatus> Read(std::string_view bytes) {
    Observed observed;
    if (DecodeInto("fleet/status", bytes, &observed) != Decoded::kYes) return std::nullopt;
    return observed.statuses.at(0);
  }
  static VehicleStatus Counted() {
    VehicleStatus status;
    status.vehicle = VehicleId{7};
    status.timing.budget_spent = 121;
    status.packets.packets.fill(~std::uint64_t{0});
    status.refused = {1, 2, 3, 4, 5, 6};
    status.timing.figures[static_cast<std::size_t>(DriveFigure::kScanLatency)].count = 8;
    status.accounts = {BeaconAccount{}, BeaconAccount{.lost = 9}};
    status.heap_bytes = ~std::uint64_t{0};
    return status;
  }
  static constexpr std::size_t kBytes = kStatusBytesBeforePackets;
  static std::size_t BytesBeforeHeap(std::size_t accounts) {
    return kStatusBytesBeforeHeap + kAccountBytes * accounts;
  }
};

TEST_F(StatusOfBefore, IsReadWithCountsOfZero) {
  const auto read = Read(std::string_view(Bytes(Counted())).substr(0, kBytes));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->vehicle, VehicleId{7});
  EXPECT_EQ(read->timing.budget_spent, 121U);
  EXPECT_EQ(read->packets, PacketCounters{});
  EXPECT_EQ(read->refused, RefusedSamples{});
  EXPECT_EQ(read->timing.Of(DriveFigure::kScanLatency), FigureSummary{});
  EXPECT_TRUE(read->accounts.Rows().empty());
}

// So that its reader, which takes no notice of what follows, reads what is meant.
TEST_F(StatusOfBefore, IsTheStartOfOneOfToday) {
  VehicleStatus plain = Counted();
  plain.packets = {};
  plain.refused = {};
  plain.accounts = {};
  EXPECT_EQ(Bytes(Counted()).substr(0, kBytes), Bytes(plain).substr(0, kBytes));
  plain.timing.budget_spent = 122;  // the last member of before ends there
  EXPECT_NE(Bytes(Counted()).substr(kBytes - 4, 4), Bytes(plain).substr(kBytes - 4, 4));
}

TEST_F(StatusOfBefore, HasOneOfThreeLengthsAndNoOther) {
  const std::string bytes = Bytes(Counted());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_EQ(
        Read(std::string_view(bytes).substr(0, length)).has_value(),
        length == kBytes || length == BytesBeforeHeap(2) || length == StatusBytesBeforeEndpoints(2))
        << length;
  }
}

TEST_F(StatusOfBefore, IsReadWithItsAccountsAndAnUnknownHeap) {
  VehicleStatus sent = Counted();
  sent.accounts = {};
  for (std::uint32_t n = 0; n <= ReportedAccounts::kMost; ++n) {
    const std::string bytes = Bytes(sent);
    EXPECT_EQ(Read(bytes)->heap_bytes, sent.heap_bytes);
    const auto read = Read(std::string_view(bytes).substr(0, BytesBeforeHeap(n)));
    ASSERT_TRUE(read) << n;
    EXPECT_EQ(read->heap_bytes, std::nullopt);
    EXPECT_EQ(read->accounts, sent.accounts);
    const auto with_heap = Read(std::string_view(bytes).substr(0, StatusBytesBeforeEndpoints(n)));
    ASSERT_TRUE(with_heap) << n;
    EXPECT_EQ(with_heap->heap_bytes, sent.heap_bytes);
    EXPECT_EQ(with_heap->packets.Of(PacketDrop::kTooManyEndpoints), 0U);
    sent.accounts.Add({VehicleId{170 + n}, 171, 172, 173, 174, 175, 176, 177, 178 + n});
  }
}

TEST(Convert, RefusesMoreAccountsThanFit) {
  wire::Status status = ToWire(VehicleStatus{});
  VehicleStatus back;
  status.accounts().resize(ReportedAccounts::kMost);
  EXPECT_TRUE(FromWire(status, back));
  status.accounts().resize(ReportedAccounts::kMost + 1);
  EXPECT_FALSE(FromWire(status, back));
}

TEST(Convert, CutsTextToItsBoundBetweenCharacters) {
  RosterEntry entry;
  entry.reason = std::string(254, 'a') + "\xC3\xA9";  // 254 bytes, then a character of two
  EXPECT_EQ(RoundTrip(entry).reason, std::string(254, 'a'));
  entry.reason = std::string(300, 'b');
  EXPECT_EQ(RoundTrip(entry).reason, std::string(255, 'b'));
}

TEST(Convert, RefusesAnEnumeratorItDoesNotKnow) {
  wire::Beacon beacon = ToWire(Beacon{});
  beacon.mode(static_cast<wire::DriveMode>(256));  // would be kCooperative if cut to 8 bits
  Beacon back;
  EXPECT_FALSE(FromWire(beacon, back).readable);
  EXPECT_EQ(back.mode, Beacon{}.mode);

  wire::RangeScan scan = ToWire(RangeScan{});
  scan.echo()[15] = static_cast<wire::EchoKind>(3);
  RangeScan scan_back;
  EXPECT_FALSE(FromWire(scan, scan_back));

  wire::MotorCommand command = ToWire(MotorCommand{});
  command.decision().rule(static_cast<wire::DriveRule>(99));
  MotorCommand command_back;
  EXPECT_FALSE(FromWire(command, command_back));

  wire::Status status = ToWire(VehicleStatus{});
  status.last_qos_event().kind(static_cast<wire::QosEventKind>(7));
  VehicleStatus status_back;
  EXPECT_FALSE(FromWire(status, status_back));
}

// One such event stopped the page of each observer that heard it.
TEST(Convert, RefusesEventsAndTruthsWhoseTimeOrPlaceIsNotFinite) {
  for (const double wrong : {kNan, kInfinity, -kInfinity}) {
    WorldEvent event;
    EXPECT_FALSE(FromWire(ToWire(WorldEvent{.time_s = wrong}), event));
    EXPECT_FALSE(FromWire(ToWire(WorldEvent{.position_world = {wrong, 0}}), event));
    EXPECT_FALSE(FromWire(ToWire(WorldEvent{.other_position_world = {0, wrong}}), event));
    Truth truth;
    EXPECT_FALSE(FromWire(ToWire(Truth{.time_s = wrong}), truth));
    EXPECT_FALSE(FromWire(ToWire(Truth{.world_from_body = {{wrong, 0}, 0}}), truth));
    EXPECT_FALSE(FromWire(ToWire(Truth{.world_from_body = {{0, 0}, wrong}}), truth));
  }
}

// Nothing between the socket and main catches what the type support throws: one malformed packet
// from anywhere would end a vehicle.
TEST(Convert, BytesThatAreNoSampleAreRefusedWithoutAnException) {
  TopicOf<wire::Roster>::Type type;
  wire::Roster roster = ToWire(RosterEntry{});
  rtps::SerializedPayload_t payload(LargestSize(type));
  ASSERT_TRUE(Serialize(type, &roster, payload));
  const std::uint32_t whole = payload.length;
  wire::Roster arrived;
  for (std::uint32_t length = 0; length < whole; ++length) {
    payload.length = length;
    EXPECT_FALSE(Deserialize(type, payload, &arrived)) << length;
  }
  payload.length = whole;
  ASSERT_TRUE(Deserialize(type, payload, &arrived));
  for (std::uint32_t i = 0; i < whole; ++i) {
    const auto kept = payload.data[i];
    for (const int corrupted : {0x02, 0x80, 0xff}) {
      payload.data[i] = static_cast<rtps::octet>(corrupted);
      EXPECT_NO_THROW(Deserialize(type, payload, &arrived)) << i << " is " << corrupted;
    }
    payload.data[i] = kept;
  }
  payload.data[0] = 1;  // of the representation: there is none with this first byte
  EXPECT_FALSE(Deserialize(type, payload, &arrived));
}

}  // namespace
}  // namespace giveway::link
