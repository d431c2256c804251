// When a vehicle's control loop continues, leaves, restarts, and asks for another place.
#include <gmock/gmock.h>

#include "tests/unit/vehicle_node/loop_bench.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr WorldEpoch kNextWorld{8};

Arrival ScanOnly(std::uint32_t turn) { return {.scan = Scan(turn), .beacons = {}, .roster = {}}; }

// Scans, and once another answer of the world.
ScriptedLink::Script ScansAnd(std::uint32_t turn_of_entry, const RosterEntry& entry) {
  return [=](std::uint32_t turn) {
    Arrival arrival = ScanOnly(turn);
    if (turn == turn_of_entry) arrival.roster = entry;
    return arrival;
  };
}

RosterEntry Answer(bool waiting, const std::string& reason) {
  RosterEntry entry = Entry(RunState::kRunning);
  entry.accepted = false;
  entry.waiting = waiting;
  entry.reason = reason;
  return entry;
}

TEST(VehicleLoop, EndsWhenTheRunEndsAndSaysSoLast) {
  LoopBench bench(ScansAnd(3, Entry(RunState::kEnded)));
  EXPECT_EQ(bench.Drive(), DriveEnd::kOver);
  EXPECT_EQ(bench.Link().Turns(), 3U);
  // No peer is left to send a leave notice to.
  EXPECT_THAT(bench.Link().SaidBesides(), ElementsAre("last status", "status heard"));
}

TEST(VehicleLoop, ThatStaysAsksTheNextWorldAsTheSameSession) {
  LoopBench bench(
      [](std::uint32_t turn) {
        Arrival arrival;
        if (turn < 10) arrival.scan = Scan(turn);
        if (turn == 10) arrival.roster = Entry(RunState::kEnded);
        return arrival;
      },
      {.stays = true});
  bench.StopAt(60);
  EXPECT_EQ(bench.Drive(), DriveEnd::kOver);
  ASSERT_GE(bench.Link().JoinRequests().size(),
            3U);  // again every second: worlds forget who does not
  for (const JoinRequest& request : bench.Link().JoinRequests()) {
    EXPECT_EQ(request.session, kSession);
    EXPECT_EQ(request.wanted, VehicleId{1});
    EXPECT_FALSE(request.leaving);
  }
}

TEST(VehicleLoop, ThatStaysDrivesOnInTheNextWorldWhichIsNoOldWordOfTheOneThatEnded) {
  LoopBench bench(
      [](std::uint32_t turn) {
        Arrival arrival;
        arrival.scan = Scan(turn, turn < 8 ? kEpoch : kNextWorld);
        if (turn == 3) arrival.roster = Entry(RunState::kEnded);
        if (turn == 5) arrival.roster = Entry(RunState::kEnded);
        if (turn == 8) arrival.roster = Entry(RunState::kRunning, kNextWorld);
        return arrival;
      },
      {.stays = true});
  bench.StopAt(12);
  bench.Drive();
  EXPECT_EQ(bench.Link().JoinRequests().size(), 1U);
  EXPECT_EQ(bench.Link().Sent().at(6).beacon.world_epoch, kEpoch);
  EXPECT_EQ(bench.Link().Sent().at(7).beacon.world_epoch, kNextWorld);
}

TEST(VehicleLoop, SaysOnceThatItsFirstScanIsAnsweredAndNotBefore) {
  LoopBench bench([](std::uint32_t turn) { return turn < 4 ? Arrival{} : ScanOnly(turn); });
  bench.Drive(8);
  EXPECT_THAT(bench.FirstScans(), ElementsAre(4U));  // three turns without one, then its answer
}

TEST(VehicleLoop, EndsAsRefusedWhereTheWorldRefusesIt) {
  LoopBench bench(ScansAnd(4, Answer(false, "the id is taken")));
  EXPECT_EQ(bench.Drive(), DriveEnd::kRefused);
  EXPECT_EQ(bench.Link().Turns(), 4U);
}

TEST(VehicleLoop, ThatLostItsPlaceAsksForAnotherUnderItsIdInItsSession) {
  LoopBench bench(ScansAnd(4, Answer(true, "silent for too long")));
  bench.StopAt(6);
  bench.Drive();
  ASSERT_EQ(bench.Link().JoinRequests().size(), 1U);
  EXPECT_EQ(bench.Link().JoinRequests().front().wanted, VehicleId{1});
  EXPECT_EQ(bench.Link().JoinRequests().front().session, kSession);
}

// Issue 25: a leave in its name removed its body, and it halted permanently.
TEST(VehicleLoop, ThatHasNoBodyInAWorldThatIsThereAsksForItsPlaceAgain) {
  LoopBench bench([](std::uint32_t turn) { return turn < 4 ? ScanOnly(turn) : Arrival{}; });
  bench.Link().SayThatItLacksBody();
  bench.StopAt(100);
  bench.Drive();
  ASSERT_FALSE(bench.Link().JoinRequests().empty());
  EXPECT_EQ(bench.Link().JoinRequests().front().wanted, VehicleId{1});
  EXPECT_EQ(bench.Link().JoinRequests().front().session, kSession);
}

TEST(VehicleLoop, WithABodyAsksForNothing) {
  LoopBench bench([](std::uint32_t turn) { return turn < 4 ? ScanOnly(turn) : Arrival{}; });
  bench.StopAt(100);
  bench.Drive();
  EXPECT_TRUE(bench.Link().JoinRequests().empty());
}

// Issue 25: the vehicle aborted.
TEST(VehicleLoop, AnEntryWithAnotherIdOrAPlaceThatCannotBeIsNotFollowed) {
  std::vector<RosterEntry> lies(3, Entry(RunState::kRunning, WorldEpoch{77}));
  lies[0].vehicle = VehicleId{2};
  lies[1].start_world.position_world.x += 100;
  lies[2].spawn = 9;
  for (const RosterEntry& lie : lies) {
    LoopBench bench(ScansAnd(4, lie));
    bench.StopAt(8);
    EXPECT_EQ(bench.Drive(), DriveEnd::kOver);
    EXPECT_EQ(bench.Link().Sent().back().command.epoch, kEpoch);
  }
}

// Regression: a vehicle far outside its scenario ignored that its run had ended, and never ended.
TEST(VehicleLoop, EndsWithItsRunWhereverItIs) {
  RosterEntry far = Entry(RunState::kEnded);
  far.start_world.position_world.x += 100;
  LoopBench bench(ScansAnd(3, far));
  EXPECT_EQ(bench.Drive(), DriveEnd::kOver);
  EXPECT_EQ(bench.Link().Turns(), 3U);
  for (const bool other_world : {false, true}) {
    RosterEntry of_another = far;
    if (other_world) of_another.epoch = kNextWorld;
    if (!other_world) of_another.vehicle = VehicleId{2};
    LoopBench stays(ScansAnd(3, of_another));
    stays.StopAt(8);
    stays.Drive();
    EXPECT_EQ(stays.Link().Turns(), 11U);  // and three good-byes
  }
}

TEST(VehicleLoop, ToldToStopSaysGoodByeThreeTimesAndLeaves) {
  LoopBench bench(ScanOnly);
  bench.StopAt(5);
  EXPECT_EQ(bench.Drive(), DriveEnd::kOver);
  EXPECT_EQ(std::ranges::count(bench.Link().Calls(), "beacon"), 5);
  // The leave is sent before the wait for peers that may have died.
  EXPECT_THAT(bench.Link().SaidBesides(),
              ElementsAre("leave notice", "leave notice", "leave notice", "last status", "leave",
                          "status heard"));
  for (std::size_t i = 5; i < 8; ++i) {
    EXPECT_EQ(bench.Link().Waits().at(i), Nanoseconds{0});
    EXPECT_EQ(bench.Link().Sent().at(i).command.target, WheelSpeeds{});
  }
}

TEST(VehicleLoop, ToldToStopAfterTheRunHasNothingToLeave) {
  LoopBench bench(ScansAnd(5, Entry(RunState::kEnded)), {.stays = true});
  bench.StopAt(7);
  bench.Drive();
  EXPECT_EQ(std::ranges::count(bench.Link().Calls(), "leave notice"), 3);
  EXPECT_EQ(std::ranges::count(bench.Link().Calls(), "leave"), 0);
}

// Its wheels turn until turn 8.
Arrival RollsUntilTheEighth(std::uint32_t turn) {
  Arrival arrival = ScanOnly(turn);
  if (turn < 8) arrival.scan->wheels = {3, 3};
  return arrival;
}

TEST(VehicleLoop, ThatAnOrderRestartsHaltsThenSaysGoodByeThenAsksForItsTime) {
  LoopBench bench(RollsUntilTheEighth);
  bench.OrderRestartAt(4);
  EXPECT_EQ(bench.Drive(), DriveEnd::kRestarts);
  const auto& sent = bench.Link().Sent();
  ASSERT_EQ(sent.size(), 11U);
  EXPECT_NE(sent.at(3).command.target, WheelSpeeds{});  // no command had been sent
  for (std::size_t i = 4; i < 8; ++i) {
    EXPECT_EQ(sent.at(i).command.target, WheelSpeeds{}) << i;
    EXPECT_NE(sent.at(i).beacon.mode, Mode::kLeaving) << i;
  }
  for (std::size_t i = 8; i < 11; ++i) EXPECT_EQ(sent.at(i).beacon.mode, Mode::kLeaving) << i;
  ASSERT_EQ(bench.Link().JoinRequests().size(), 1U);
  EXPECT_EQ(bench.Link().JoinRequests().front().session, kSession);  // it keeps its place
  std::vector<std::string> last(bench.Link().Calls().end() - 3, bench.Link().Calls().end());
  EXPECT_THAT(last, ElementsAre("join 1", "join heard", "answer heard"));
  EXPECT_EQ(std::ranges::count(bench.Link().Calls(), "leave"), 0);
  EXPECT_TRUE(bench.Loop().HandOver().has_value());
}

TEST(VehicleLoop, ThatNeverStandsRestartsAfterFiveSecondsAllTheSame) {
  LoopBench bench([](std::uint32_t turn) {
    Arrival arrival = ScanOnly(turn);
    arrival.scan->wheels = {3, 3};
    return arrival;
  });
  bench.OrderRestartAt(2);
  const SteadyTime begun = bench.Now();
  EXPECT_EQ(bench.Drive(), DriveEnd::kRestarts);
  EXPECT_GE(bench.Now() - begun, seconds(5));
  EXPECT_LE(bench.Now() - begun, seconds(6));
}

TEST(VehicleLoop, ToldToStopWhileItAsksForItsTimeLeaves) {
  LoopBench bench(RollsUntilTheEighth);
  bench.OrderRestartAt(4);
  bench.StopAsItAsksForTime();
  EXPECT_EQ(bench.Drive(), DriveEnd::kOver);
  EXPECT_THAT(bench.Link().Calls(), ::testing::IsSupersetOf({"join 1", "leave", "last status"}));
}

// In the next world, at a spawn place of another profile.
RosterEntry SpawnedElsewhere() {
  RosterEntry elsewhere = Entry(RunState::kRunning, kNextWorld);
  elsewhere.start_world = {{4, 5}, 1};
  elsewhere.spawn = 1;
  return elsewhere;
}

Arrival IsSpawnedElsewhereAtTheFifth(std::uint32_t turn) {
  Arrival arrival;
  arrival.scan = Scan(turn, turn < 5 ? kEpoch : kNextWorld);
  if (turn == 5) arrival.roster = SpawnedElsewhere();
  return arrival;
}

TEST(VehicleLoop, IsReseatedByANewEpoch) {
  LoopBench bench(IsSpawnedElsewhereAtTheFifth);
  bench.StopAt(6);
  EXPECT_EQ(bench.Drive(), DriveEnd::kOver);
  const auto& sent = bench.Link().Sent();
  EXPECT_EQ(sent.at(3).beacon.world_epoch, kEpoch);
  EXPECT_EQ(sent.at(4).beacon.world_epoch, kNextWorld);
  EXPECT_EQ(sent.at(4).beacon.world_from_body, SpawnedElsewhere().start_world);
  EXPECT_EQ(sent.at(3).beacon.cruise_m_s, DefaultOptions().cruise_m_s);
  EXPECT_EQ(sent.at(4).beacon.cruise_m_s, LoopBench::kSpawnCruise_m_s);
  EXPECT_EQ(sent.at(4).beacon.boot_epoch, sent.at(3).beacon.boot_epoch);
}

// It drove on without a reader for the radar that its new profile has.
TEST(VehicleLoop, ThatIsGivenAPlaceWithOtherSensorsRestartsAndKeepsThePlace) {
  LoopBench bench(IsSpawnedElsewhereAtTheFifth);
  bench.FitRadarAtSpawn();
  EXPECT_EQ(bench.Drive(), DriveEnd::kRestarts);
  EXPECT_EQ(bench.Link().Sent().at(4).command.target, WheelSpeeds{});
  ASSERT_EQ(bench.Link().JoinRequests().size(), 1U);
  EXPECT_EQ(bench.Link().JoinRequests().front().session, kSession);
  EXPECT_EQ(std::ranges::count(bench.Link().Calls(), "leave"), 0);
}

TEST(VehicleLoop, ThatIsDeafWhileItsWorldSpeaksRestartsForANewParticipant) {
  LoopBench bench([](std::uint32_t turn) {
    Arrival arrival;
    if (turn < 5) arrival.scan = Scan(turn);
    return arrival;
  });
  bench.Link().SayThatWorldSpeaks();
  const SteadyTime begun = bench.Now();
  EXPECT_EQ(bench.Drive(), DriveEnd::kRestarts);
  EXPECT_GE(bench.Now() - begun, seconds(10));
  EXPECT_EQ(std::ranges::count(bench.Link().Calls(), "leave notice"), 3);
  EXPECT_EQ(bench.Link().JoinRequests().size(), 1U);
}

TEST(VehicleLoop, WhoseSharedMemoryWasDeletedRestartsForANewParticipant) {
  LoopBench bench(ScanOnly);
  bench.Link().DeleteSharedMemory();
  const SteadyTime begun = bench.Now();
  EXPECT_EQ(bench.Drive(), DriveEnd::kRestarts);
  EXPECT_LE(bench.Now() - begun, seconds(2));
  EXPECT_EQ(std::ranges::count(bench.Link().Calls(), "leave notice"), 3);
}

// What it came back for, an operator's order, is reported as done with the first scan.
TEST(VehicleLoop, WhoseSharedMemoryWasDeletedRestartsNoSoonerThanItsFirstScan) {
  LoopBench bench([](std::uint32_t turn) {
    Arrival arrival;
    if (turn >= 30) arrival.scan = Scan(turn);
    return arrival;
  });
  bench.Link().DeleteSharedMemory();
  EXPECT_EQ(bench.Drive(), DriveEnd::kRestarts);
  EXPECT_EQ(bench.FirstScans().size(), 1U);
}

TEST(VehicleLoop, InLockstepKeepsDrivingWithoutItsSharedMemory) {
  LoopBench bench(ScanOnly, {.lockstep = true});
  bench.Link().DeleteSharedMemory();
  EXPECT_NE(bench.Drive(), DriveEnd::kRestarts);
}

TEST(VehicleLoop, WhoseInterfaceChangedEndsWithoutAWord) {
  LoopBench bench([](std::uint32_t turn) {
    Arrival arrival;
    if (turn < 5) arrival.scan = Scan(turn);
    return arrival;
  });
  bench.Link().ChangeInterface("interface eth0 has another address");
  EXPECT_EQ(bench.Drive(), DriveEnd::kScansLost);
  EXPECT_THAT(bench.Link().SaidBesides(), IsEmpty());
}

// Beacons that arrive between two ticks count in the decision of the next one.
TEST(VehicleLoop, InLockstepHoldsBeaconsUntilATick) {
  LoopBench bench(
      [](std::uint32_t turn) {
        Arrival arrival;
        if (turn == 1 || turn >= 4) arrival.scan = Scan(turn == 1 ? 1 : turn - 2);
        if (turn == 2) arrival.beacons = {BeaconOf(2, 1, {{3, 1}, 0})};
        return arrival;
      },
      {.lockstep = true});
  bench.StopAt(4);
  bench.Drive();
  const auto& sent = bench.Link().Sent();
  ASSERT_EQ(sent.size(), 5U);  // of turns 1 and 4, and the good-byes
  EXPECT_EQ(sent.at(0).command.tick, Tick{1});
  EXPECT_EQ(sent.at(1).command.tick, Tick{2});
  EXPECT_EQ(bench.Link().LastStatus().beacons.accepted, 1U);
}

// It took a core for itself until the next tick.
TEST(VehicleLoop, InLockstepWaitsForItsScanAgainWhereNoneCame) {
  LoopBench bench(
      [](std::uint32_t turn) {
        Arrival arrival;
        if (turn < 3) arrival.scan = Scan(turn);
        return arrival;
      },
      {.lockstep = true});
  bench.StopAt(20);
  bench.Drive();
  for (std::size_t i = 3; i < 20; ++i) EXPECT_GE(bench.Link().Waits().at(i), milliseconds(50)) << i;
}

TEST(VehicleLoop, AwaitsAScanHalfAPeriodLongerThanItShouldTake) {
  LoopBench bench(ScanOnly);
  bench.StopAt(4);
  bench.Drive();
  EXPECT_EQ(bench.Link().Waits().at(0), Nanoseconds{0});  // it has said nothing yet
  EXPECT_EQ(bench.Link().Waits().at(3), milliseconds(75));
}

TEST(VehicleLoop, ThatIsBlindKeepsTheRateOfItsBeacons) {
  LoopBench bench([](std::uint32_t turn) {
    Arrival arrival;
    if (turn < 5) arrival.scan = Scan(turn);
    return arrival;
  });
  bench.StopAt(20);
  bench.Drive();
  EXPECT_EQ(bench.Link().Waits().at(5), milliseconds(75));  // the first that did not come
  for (std::size_t i = 8; i < 20; ++i) EXPECT_EQ(bench.Link().Waits().at(i), milliseconds(50)) << i;
  EXPECT_EQ(bench.Link().Sent().size(), 23U);  // a beacon a turn all the same
}

TEST(VehicleLoop, SendsItsStatusFiveTimesASecond) {
  LoopBench bench(ScanOnly);
  bench.StopAt(41);  // two seconds
  bench.Drive();
  const auto statuses = std::ranges::count(bench.Link().Calls(), "status");
  EXPECT_GE(statuses, 10);
  EXPECT_LE(statuses, 14);  // and where the decision changes
}

}  // namespace
}  // namespace giveway::test
