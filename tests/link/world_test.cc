// Vehicle, world and observer together: joining, ranges, commands, and what a latecomer still
// learns.
#include <gmock/gmock.h>
#include <malloc.h>

#include <cmath>
#include <limits>
#include <memory>

#include "services/link/observer_link.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;

constexpr VehicleId kSeven{7};

RangeScan ScanOf(VehicleId id, std::uint32_t tick) {
  RangeScan scan;
  scan.vehicle = id;
  scan.epoch = WorldEpoch{1};
  scan.tick = Tick{tick};
  return scan;
}

RosterEntry Accepted(const SessionId& session, VehicleId vehicle) {
  RosterEntry entry;
  entry.session = session;
  entry.vehicle = vehicle;
  entry.accepted = true;
  entry.epoch = WorldEpoch{1};
  return entry;
}

// A world and an open vehicle 7 that hear each other.
class Pair : public ::testing::Test {
 protected:
  Pair() : world_(OptionsIn(domain_)), vehicle_(OptionsIn(domain_)) {
    world_.OpenRanges(kSeven);
    vehicle_.Open(kSeven);
  }
  void SetUp() override {
    ASSERT_TRUE(Eventually([&] {
      world_.SendScan(ScanOf(kSeven, 1));
      vehicle_.Send(BeaconFrom(kSeven, 1));
      const bool commanded = !world_.TakeCommands().empty();
      return vehicle_.Take(SteadyTime{0}).inputs.scan.has_value() && commanded &&
             world_.IsMatched(kSeven);
    }));
    while (vehicle_.WaitForScan(milliseconds(50))) vehicle_.Take(SteadyTime{0});
    while (world_.WaitForCommands(milliseconds(50))) world_.TakeCommands();
  }

  DomainLock domain_;
  link::WorldLink world_;
  link::VehicleLink vehicle_;
};

// It publishes nothing before a vehicle joins, and was taken for silent.
TEST(Observing, FindsAWorldWithoutVehiclesUntilItLeaves) {
  const DomainLock domain;
  link::ObserverLink observer(OptionsIn(domain));
  EXPECT_EQ(observer.Take().world, 0U);
  auto world = std::make_unique<link::WorldLink>(OptionsIn(domain));
  EXPECT_TRUE(Eventually([&] { return observer.Take().world != 0; }));
  world.reset();
  EXPECT_TRUE(Eventually([&] { return observer.Take().world == 0; }));
}

TEST(Joining, IsAnsweredBySessionAndARefusalLeavesTheOwnersEntryAlone) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::VehicleLink owner(OptionsIn(domain));
  link::VehicleLink second(OptionsIn(domain));
  const SessionId owner_session{1, 2, 3, 4};
  const SessionId second_session{5, 6, 7, 8};
  second.SendJoin({SessionId{}, kSeven});  // no 128 random bits: refused, and said
  owner.SendJoin({owner_session, kSeven});
  second.SendJoin({second_session, kSeven});
  std::vector<JoinRequest> joins;
  std::vector<Refusal> refusals;
  ASSERT_TRUE(Eventually([&] {
    for (const JoinRequest& join : world.TakeJoins()) joins.push_back(join);
    for (const Refusal& refusal : world.TakeRefusals()) refusals.push_back(refusal);
    return joins.size() == 2 && !refusals.empty();
  }));
  EXPECT_EQ(refusals[0].why, "session is 0, must be 128 random bits");
  EXPECT_EQ(joins[0].wanted, kSeven);
  EXPECT_EQ(joins[1].wanted, kSeven);

  RosterEntry refusal = Accepted(second_session, kSeven);
  refusal.accepted = false;
  refusal.reason = "vehicle 7 is taken";
  world.SendRoster(Accepted(owner_session, kSeven));
  world.SendRoster(refusal);
  std::optional<RosterEntry> accepted;
  std::optional<RosterEntry> refused;
  ASSERT_TRUE(Eventually([&] {
    if (!accepted) accepted = owner.TakeRoster(owner_session);
    if (!refused) refused = second.TakeRoster(second_session);
    return accepted && refused;
  }));
  EXPECT_TRUE(accepted->accepted);
  EXPECT_FALSE(refused->accepted);
  EXPECT_EQ(refused->reason, "vehicle 7 is taken");
}

TEST(Joining, BeforeTheWorldIsThereIsHeardWhenItComes) {
  const DomainLock domain;
  link::VehicleLink early(OptionsIn(domain));
  early.SendJoin({{1, 2, 3, 4}, kNoVehicle});
  link::WorldLink world(OptionsIn(domain));
  EXPECT_TRUE(Eventually([&] { return world.TakeJoins().size() == 1; }));
}

TEST(Joining, ALateVehicleFindsTheWholeRoster) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  for (std::uint32_t i = 1; i <= 12; ++i) {
    world.SendRoster(Accepted({i, 0, 0, 0}, VehicleId{i}));
  }
  link::ObserverLink late(OptionsIn(domain));
  std::vector<RosterEntry> roster;
  EXPECT_TRUE(Eventually([&] {
    for (const RosterEntry& entry : late.Take().roster) roster.push_back(entry);
    return roster.size() == 12;
  })) << roster.size();
}

// Issue 21, number 11: each event took 600 bytes more, until 256 + 32 a vehicle had happened.
TEST(Events, FillTheirHistoryWithoutTakingMoreMemory) {
  const DomainLock domain;
  link::LinkOptions options = OptionsIn(domain);
  options.fleet_size = 16;
  link::WorldLink world(options);
  const auto send = [&](int events) {
    for (int i = 0; i < events; ++i) {
      WorldEvent event;
      event.text = "vehicle 7";
      world.SendEvent(event);
    }
  };
  send(32);
  const std::size_t before = mallinfo2().uordblks;
  send(800);
  EXPECT_LT(mallinfo2().uordblks, before + 64 * 1024);
}

TEST_F(Pair, TheWaitEndsWithAScanAndWithoutOneAtItsTimeout) {
  EXPECT_FALSE(vehicle_.WaitForScan(milliseconds(20)));
  world_.SendScan(ScanOf(kSeven, 2));
  EXPECT_TRUE(vehicle_.WaitForScan(seconds(10)));
  const link::Taken taken = vehicle_.Take(SteadyTime{5});
  ASSERT_TRUE(taken.inputs.scan.has_value());
  EXPECT_EQ(taken.inputs.scan->tick, Tick{2});
  EXPECT_EQ(taken.inputs.now, SteadyTime{5});
  EXPECT_FALSE(vehicle_.WaitForScan(milliseconds(20)));
}

TEST_F(Pair, OfSeveralScansTheNewestIsUsedAndTheOthersAreCounted) {
  for (std::uint32_t tick = 2; tick <= 4; ++tick) world_.SendScan(ScanOf(kSeven, tick));
  std::optional<RangeScan> newest;
  std::uint32_t scans = 0;
  ASSERT_TRUE(Eventually([&] {
    const link::Taken taken = vehicle_.Take(SteadyTime{0});
    scans += taken.scans_skipped + (taken.inputs.scan ? 1 : 0);
    if (taken.inputs.scan) newest = taken.inputs.scan;
    return scans == 3;
  }));
  EXPECT_EQ(newest->tick, Tick{4});
}

TEST_F(Pair, AScanOfAnotherVehicleDoesNotReachThisOne) {
  world_.OpenRanges(VehicleId{8});
  world_.SendScan(ScanOf(VehicleId{8}, 9));
  world_.SendScan(ScanOf(kSeven, 2));
  ASSERT_TRUE(vehicle_.WaitForScan(seconds(10)));
  EXPECT_EQ(vehicle_.Take(SteadyTime{0}).inputs.scan->vehicle, kSeven);
  EXPECT_EQ(vehicle_.Counters().refused.wrong_name_scans, 0U);
}

TEST_F(Pair, ASilentWorldIsOneMissAndANewScanEndsIt) {
  const auto misses = [&] { return vehicle_.Counters().ranges_deadline_missed; };
  world_.SendScan(ScanOf(kSeven, 2));
  ASSERT_TRUE(vehicle_.WaitForScan(seconds(10)));
  vehicle_.Take(SteadyTime{0});
  const std::uint32_t before = misses();
  Repeat(milliseconds(1000), [&] { vehicle_.Take(SteadyTime{0}); });
  EXPECT_EQ(misses(), before + 1);
  world_.SendScan(ScanOf(kSeven, 3));
  ASSERT_TRUE(vehicle_.WaitForScan(seconds(10)));
  vehicle_.Take(SteadyTime{0});
  EXPECT_TRUE(Eventually([&] {
    vehicle_.Take(SteadyTime{0});
    return misses() == before + 2;
  }));
}

TEST_F(Pair, CommandsReachTheWorldInOrder) {
  for (std::uint32_t seq = 2; seq <= 4; ++seq) vehicle_.Send(BeaconFrom(kSeven, seq));
  std::vector<Tick> ticks;
  ASSERT_TRUE(Eventually([&] {
    for (const MotorCommand& command : world_.TakeCommands()) ticks.push_back(command.tick);
    return ticks.size() == 3;
  }));
  EXPECT_THAT(ticks, ElementsAre(Tick{2}, Tick{3}, Tick{4}));
}

TEST_F(Pair, ACommandThatIsNotFiniteOrInAnothersNameIsRefusedAndCounted) {
  Outputs wild = BeaconFrom(kSeven, 2);
  wild.command.target.left_rad_s = std::numeric_limits<double>::quiet_NaN();
  vehicle_.Send(wild);
  Outputs misnamed = BeaconFrom(VehicleId{8}, 3);
  vehicle_.Send(misnamed);
  EXPECT_TRUE(Eventually([&] {
    EXPECT_TRUE(world_.TakeCommands().empty());
    return world_.Counters().commands_not_finite == 1 && world_.Counters().commands_wrong_name == 1;
  }));
}

TEST_F(Pair, TheWaitForCommandsEndsWithOne) {
  EXPECT_FALSE(world_.WaitForCommands(milliseconds(20)));
  vehicle_.Send(BeaconFrom(kSeven, 2));
  EXPECT_TRUE(world_.WaitForCommands(seconds(10)));
}

TEST(Matching, IsTrueOnlyWithBothDirections) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  world.OpenRanges(kSeven);
  EXPECT_FALSE(world.IsMatched(kSeven));
  {
    link::VehicleLink vehicle(OptionsIn(domain));
    vehicle.Open(kSeven);
    EXPECT_TRUE(Eventually([&] { return world.IsMatched(kSeven); }));
    EXPECT_FALSE(world.IsMatched(VehicleId{8}));
  }
  EXPECT_TRUE(Eventually([&] { return !world.IsMatched(kSeven); }));
}

TEST(Observing, ALatecomerLearnsEventsInOrderRosterAndFigures) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  WorldEvent event;
  for (event.seq = 1; event.seq <= 100; ++event.seq) world.SendEvent(event);
  RunFigures sent;
  sent.reason = "expectations_met";
  world.SendFigures(sent);
  link::ObserverLink late(OptionsIn(domain));
  std::vector<WorldEvent> events;
  std::optional<RunFigures> figures;
  ASSERT_TRUE(Eventually([&] {
    link::Observed observed = late.Take();
    events.insert(events.end(), observed.events.begin(), observed.events.end());
    if (observed.figures) figures = observed.figures;
    return events.size() == 100 && figures.has_value();
  }));
  for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(events[i].seq, i + 1);
  EXPECT_EQ(figures->reason, "expectations_met");
}

TEST_F(Pair, AnObserverHearsTruthAndStatusAndRefusesAMisnamedOne) {
  link::ObserverLink observer(OptionsIn(domain_));
  VehicleStatus status;
  status.vehicle = kSeven;
  VehicleStatus misnamed;
  misnamed.vehicle = VehicleId{8};
  Truth truth;
  truth.vehicle = kSeven;
  bool status_came = false;
  bool truth_came = false;
  bool refused = false;
  EXPECT_TRUE(Eventually([&] {
    vehicle_.SendStatus(status);
    vehicle_.SendStatus(misnamed);
    world_.SendTruth(truth);
    const link::Observed observed = observer.Take();
    for (const VehicleStatus& one : observed.statuses) {
      EXPECT_EQ(one.vehicle, kSeven);
      status_came = true;
    }
    truth_came |= !observed.truths.empty();
    refused |= observed.refused > 0;
    return status_came && truth_came && refused;
  }));
}

TEST_F(Pair, AFlushedLastStatusHasArrived) {
  link::ObserverLink observer(OptionsIn(domain_));
  VehicleStatus status;
  status.vehicle = kSeven;
  ASSERT_TRUE(Eventually([&] {
    vehicle_.SendStatus(status);
    return !observer.Take().statuses.empty();
  }));
  status.final = true;
  vehicle_.SendStatus(status);
  vehicle_.FlushStatus(seconds(10));
  const std::vector<VehicleStatus> statuses = observer.Take().statuses;
  ASSERT_FALSE(statuses.empty());
  EXPECT_TRUE(statuses.back().final);
}

// As that of a soak. What it does not ask for twice is not lost by coming late.
TEST_F(Pair, AnObserverThatLetsPacketsGatherHearsEachStatusInOrder) {
  link::LinkOptions options = OptionsIn(domain_);
  options.requests_status_once = true;
  options.lets_packets_gather = true;
  link::ObserverLink observer(options);
  VehicleStatus status;
  status.vehicle = kSeven;
  std::vector<Tick> heard;
  const auto listen = [&] {
    for (const VehicleStatus& one : observer.Take().statuses) heard.push_back(one.tick);
  };
  const Tick first = status.tick;
  ASSERT_TRUE(Eventually([&] {
    vehicle_.SendStatus(status);
    listen();
    return !heard.empty();
  }));
  std::vector<Tick> sent;
  for (std::uint32_t tick = 1; tick <= 100; ++tick) {
    status.tick = sent.emplace_back(Tick{tick});
    vehicle_.SendStatus(status);
    if (tick % 10 != 0) continue;
    EXPECT_TRUE(Eventually([&] {
      listen();
      std::erase(heard, first);  // those that were sent until one was heard
      return heard.size() == sent.size();
    })) << tick;
  }
  EXPECT_EQ(heard, sent);
}

TEST_F(Pair, NothingFailedToBeWritten) {
  EXPECT_EQ(vehicle_.Counters().write_failures, 0U);
  EXPECT_EQ(world_.Counters().write_failures, 0U);
  EXPECT_EQ(vehicle_.Counters().events_dropped, 0U);
}

}  // namespace
}  // namespace giveway::test
