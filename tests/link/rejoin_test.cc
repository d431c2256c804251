// Leaving, coming back, and a world that is followed by another.
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <functional>

#include "services/link/observer_link.h"
#include "services/link/world_link.h"
#include "services/types/sanitizers.h"
#include "tests/link/fleet.h"

#ifdef GIVEWAY_ADDRESS_SANITIZER
// Of the sanitizer's interface; Debian's g++ does not bring the header along.
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace giveway::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr VehicleId kSeven{7};
constexpr SessionId kSession{1, 2, 3, 4};

RosterEntry Accepted(const SessionId& session, VehicleId vehicle, std::uint32_t epoch = 1) {
  RosterEntry entry;
  entry.session = session;
  entry.vehicle = vehicle;
  entry.accepted = true;
  entry.epoch = WorldEpoch{epoch};
  return entry;
}

RangeScan ScanOf(std::uint32_t epoch) {
  RangeScan scan;
  scan.vehicle = kSeven;
  scan.epoch = WorldEpoch{epoch};
  scan.tick = Tick{1};
  return scan;
}

// The first request that comes.
std::optional<JoinRequest> AwaitJoin(link::WorldLink& world) {
  std::optional<JoinRequest> request;
  Eventually([&] {
    for (const JoinRequest& one : world.TakeJoins()) request = one;
    return request.has_value();
  });
  return request;
}

// Joins as any vehicle, is given 7 and opens.
void JoinAsSeven(link::VehicleLink& vehicle, link::WorldLink& world) {
  vehicle.SendJoin({kSession, kNoVehicle});
  const auto request = AwaitJoin(world);
  ASSERT_TRUE(request.has_value());
  world.SendRoster(Accepted(request->session, kSeven));
  world.OpenVehicle(kSeven, RobotModel{});
  ASSERT_TRUE(Eventually([&] { return vehicle.TakeRoster(kSession).has_value(); }));
  vehicle.Open(kSeven, RobotModel{}, false);
}

TEST(Rejoining, ASecondWorldFindsTheVehicleUnderItsIdAndIsHeard) {
  const DomainLock domain;
  link::VehicleLink vehicle(OptionsIn(domain));
  {
    link::WorldLink first(OptionsIn(domain));
    JoinAsSeven(vehicle, first);
    ASSERT_TRUE(Eventually([&] { return first.IsMatched(kSeven); }));
  }
  const auto begin = std::chrono::steady_clock::now();
  link::WorldLink second(OptionsIn(domain));
  const auto request = AwaitJoin(second);
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->session, kSession);
  EXPECT_EQ(request->wanted, kSeven);
  EXPECT_FALSE(request->leaving);
  second.SendRoster(Accepted(kSession, kSeven, 2));
  second.OpenVehicle(kSeven, RobotModel{});
  std::optional<RosterEntry> received;
  bool scan_came = false;
  ASSERT_TRUE(Eventually([&] {
    second.SendScan(ScanOf(2));
    const Inputs inputs = vehicle.Take(SteadyTime{0}).inputs;
    if (inputs.roster) received = inputs.roster;
    scan_came |= inputs.scan.has_value();
    return received && scan_came;
  }));
  EXPECT_EQ(received->epoch, WorldEpoch{2});
  const auto took = std::chrono::steady_clock::now() - begin;
  // Usually a fifth of a second; a first match that is missed waits for the next announcement.
  EXPECT_LT(took, seconds(5));
  EXPECT_EQ(vehicle.Counters().refused.old_world_entries, 0U);
}

TEST(Rejoining, TheEntryThatLetAVehicleInIsNotToldAgainAndALaterOneOnce) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::VehicleLink vehicle(OptionsIn(domain));
  JoinAsSeven(vehicle, world);
  Repeat(milliseconds(200), [&] { EXPECT_FALSE(vehicle.Take(SteadyTime{0}).inputs.roster); });
  RosterEntry ended = Accepted(kSession, kSeven);
  ended.run_state = RunState::kEnded;
  world.SendRoster(Accepted({9, 9, 9, 9}, VehicleId{9}));
  world.SendRoster(ended);
  int received = 0;
  const auto take = [&] {
    if (const auto entry = vehicle.Take(SteadyTime{0}).inputs.roster) {
      ++received;
      EXPECT_EQ(entry->run_state, RunState::kEnded);
    }
    return received > 0;
  };
  ASSERT_TRUE(Eventually(take));
  Repeat(milliseconds(200), take);
  EXPECT_EQ(received, 1);
  EXPECT_TRUE(vehicle.TakeRoster(kSession).has_value()) << "Take and TakeRoster each report it";
}

// Until the vehicle hears the world, which speaks at every turn.
bool HearsItsWorld(link::VehicleLink& vehicle, const std::function<void()>& speak) {
  return Eventually([&] {
    speak();
    return vehicle.Take(SteadyTime{0}).inputs.scan.has_value();
  });
}

// The first entry that a vehicle that has just heard its world takes in that time.
struct Heard {
  std::optional<RosterEntry> entry;
  std::chrono::nanoseconds silence{0};  // of its world, before the entry
};
Heard HeardWithin(milliseconds duration, link::VehicleLink& vehicle,
                  const std::function<void()>& speak) {
  Heard heard;
  auto spoke = std::chrono::steady_clock::now();
  Repeat(duration, [&] {
    speak();
    const Inputs inputs = vehicle.Take(SteadyTime{0}).inputs;
    if (heard.entry) return;
    if (inputs.scan) spoke = std::chrono::steady_clock::now();
    heard.entry = inputs.roster;
    heard.silence = std::chrono::steady_clock::now() - spoke;
  });
  return heard;
}

// A world that the machine keeps from speaking is silent, and another one rightly believed.
#define SKIP_IF_SILENT(heard)                                 \
  if ((heard).entry && (heard).silence > milliseconds(900)) { \
    GTEST_SKIP() << "the machine stopped for a second";       \
  }

// Making a world takes a second under a sanitizer, and a world silent for a second may be followed:
// both are there before the first one is believed.
TEST(Rejoining, ASecondWorldIsNotBelievedWhileTheFirstLivesAndIsOnceThatHasLeft) {
  const DomainLock domain;
  link::VehicleLink vehicle(OptionsIn(domain));
  auto first = std::make_unique<link::WorldLink>(OptionsIn(domain));
  link::WorldLink second(OptionsIn(domain));
  JoinAsSeven(vehicle, *first);
  ASSERT_TRUE(AwaitJoin(second).has_value());
  const auto speak = [&] { first->SendScan(ScanOf(1)); };
  ASSERT_TRUE(HearsItsWorld(vehicle, speak));
  second.SendRoster(Accepted(kSession, kSeven, 2));
  const Heard heard = HeardWithin(milliseconds(2500), vehicle, speak);
  SKIP_IF_SILENT(heard);
  EXPECT_FALSE(heard.entry.has_value());
  EXPECT_EQ(vehicle.Counters().refused.old_world_entries, 1U);
  first.reset();
  std::optional<RosterEntry> received;
  ASSERT_TRUE(Eventually([&] {
    received = vehicle.Take(SteadyTime{0}).inputs.roster;
    return received.has_value();
  }));
  EXPECT_EQ(received->epoch, WorldEpoch{2});
}

TEST(Rejoining, AWorldThatFellSilentIsFollowedByTheNextAndNoLongerBelieved) {
  const DomainLock domain;
  link::VehicleLink vehicle(OptionsIn(domain));
  link::WorldLink first(OptionsIn(domain));
  JoinAsSeven(vehicle, first);
  link::WorldLink second(OptionsIn(domain));
  ASSERT_TRUE(AwaitJoin(second).has_value());
  second.OpenVehicle(kSeven, RobotModel{});
  second.SendRoster(Accepted(kSession, kSeven, 2));
  const auto speak = [&] { second.SendScan(ScanOf(2)); };
  std::optional<RosterEntry> received;
  ASSERT_TRUE(Eventually([&] {
    speak();
    received = vehicle.Take(SteadyTime{0}).inputs.roster;
    return received.has_value();
  }));
  EXPECT_EQ(received->epoch, WorldEpoch{2});
  ASSERT_TRUE(HearsItsWorld(vehicle, speak));
  first.SendRoster(Accepted(kSession, kSeven, 3));
  const Heard heard = HeardWithin(milliseconds(1500), vehicle, speak);
  SKIP_IF_SILENT(heard);
  EXPECT_FALSE(heard.entry.has_value());
}

TEST(Rejoining, AnEntryThatCannotBeBelievedIsRefusedByFieldAndChangesNothing) {
  const DomainLock domain;
  link::VehicleLink vehicle(OptionsIn(domain));
  link::WorldLink world(OptionsIn(domain));
  JoinAsSeven(vehicle, world);
  RosterEntry broken = Accepted(kSession, kSeven, 2);
  broken.start_world.position_world.x = std::nan("");
  world.SendRoster(broken);
  world.SendRoster(Accepted(kSession, VehicleId{8}, 3));
  std::vector<std::string> fields;
  EXPECT_TRUE(Eventually([&] {
    const link::Taken taken = vehicle.Take(SteadyTime{0});
    EXPECT_FALSE(taken.inputs.roster.has_value());
    for (const Refusal& refusal : taken.refusals) fields.emplace_back(refusal.field);
    return vehicle.Counters().refused.implausible == 2;
  }));
  EXPECT_THAT(fields, ::testing::ElementsAre("start_world.x_m", "vehicle"));
}

TEST(Leaving, ReachesTheWorldThoughTheLinkClosesAtOnce) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  for (std::uint32_t i = 1; i <= 10; ++i) {
    auto vehicle = std::make_unique<link::VehicleLink>(OptionsIn(domain));
    vehicle->SendJoin({{i, 0, 0, 0}, kSeven});
    ASSERT_TRUE(AwaitJoin(world).has_value());
    vehicle->SendLeave({i, 0, 0, 0});
    vehicle.reset();
    const auto request = AwaitJoin(world);
    ASSERT_TRUE(request.has_value()) << i;
    EXPECT_TRUE(request->leaving);
    EXPECT_EQ(request->wanted, kSeven);
    EXPECT_EQ(request->session[0], i);
  }
}

TEST(Leaving, IsTakenBeforeTheJoinOfWhoeverComesInstead) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::VehicleLink leaving(OptionsIn(domain));
  leaving.SendJoin({{9, 0, 0, 0}, kSeven});
  ASSERT_TRUE(AwaitJoin(world).has_value());
  link::VehicleLink coming(OptionsIn(domain));
  coming.SendJoin({{1, 0, 0, 0}, kSeven});
  leaving.SendLeave({9, 0, 0, 0});
  // One is taken with the other only if both are there: ask until they came together.
  ASSERT_TRUE(Eventually([&] {
    Repeat(milliseconds(100), [] {});
    const std::vector<JoinRequest> joins = world.TakeJoins();
    if (joins.size() == 2) {
      EXPECT_TRUE(joins[0].leaving);
      EXPECT_FALSE(joins[1].leaving);
      return true;
    }
    coming.SendJoin({{1, 0, 0, 0}, kSeven});
    leaving.SendLeave({9, 0, 0, 0});
    return false;
  }));
}

TEST(Leaving, AClosedVehicleMayComeBackInTheSameSession) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::VehicleLink vehicle(OptionsIn(domain));
  JoinAsSeven(vehicle, world);
  for (std::uint32_t epoch = 2; epoch <= 5; ++epoch) {
    ASSERT_TRUE(Eventually([&] { return world.IsMatched(kSeven); }));
    world.CloseVehicle(kSeven);
    EXPECT_FALSE(world.IsMatched(kSeven));
    world.OpenVehicle(kSeven, RobotModel{});
    world.SendRoster(Accepted(kSession, kSeven, epoch));
    bool received = false;
    bool scanned = false;
    EXPECT_TRUE(Eventually([&] {
      world.SendScan(ScanOf(epoch));
      const Inputs inputs = vehicle.Take(SteadyTime{0}).inputs;
      received |= inputs.roster && inputs.roster->epoch == WorldEpoch{epoch};
      scanned |= inputs.scan && inputs.scan->epoch == WorldEpoch{epoch};
      return received && scanned;
    })) << epoch;
  }
}

TEST(Leaving, ALatecomerIsNotToldOfThoseThatLeftOrWereRefusedLongAgo) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  for (std::uint32_t i = 1; i <= 500; ++i) {
    RosterEntry refused = Accepted({i, 2, 0, 0}, kSeven);
    refused.accepted = false;
    world.SendRoster(refused);
    world.SendRoster(Accepted({i, 1, 0, 0}, VehicleId{i}));
    if (i <= 400) world.CloseVehicle(VehicleId{i});
  }
  link::ObserverLink late(OptionsIn(domain));
  std::vector<RosterEntry> accepted;
  std::size_t refused = 0;
  ASSERT_TRUE(Eventually([&] {
    for (const RosterEntry& entry : late.Take().roster) {
      refused += entry.accepted ? 0 : 1;
      if (entry.accepted) accepted.push_back(entry);
    }
    return accepted.size() >= 100;
  }));
  for (const RosterEntry& entry : accepted) EXPECT_GT(entry.session[0], 400U);
  EXPECT_EQ(accepted.size(), 100U);
  EXPECT_LE(refused, 64U);
}

// Memory of this process, kB: resident, or under the address sanitizer, which keeps what was freed
// for a while, what the heap has given out.
long MemoryKb() {
#ifdef GIVEWAY_ADDRESS_SANITIZER
  return static_cast<long>(__sanitizer_get_current_allocated_bytes() / 1024);
#else
  std::ifstream file("/proc/self/statm");
  long total = 0;
  long resident = 0;
  file >> total >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
#endif
}

TEST(Leaving, AndComingAThousandTimesLeavesNothingBehind) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::VehicleLink onlooker(OptionsIn(domain));
  onlooker.Open(VehicleId{1000});
  const auto come_and_go = [&](std::uint32_t times) {
    for (std::uint32_t i = 1; i <= times; ++i) {
      const VehicleId vehicle{i % 5 + 1};
      RobotModel profile;
      profile.radar = profile.lidar = profile.camera = true;
      world.OpenVehicle(vehicle, profile);
      world.SendRoster(Accepted({times, i, 0, 0}, vehicle));
      world.IsMatched(vehicle);
      world.CloseVehicle(vehicle);
      onlooker.Take(SteadyTime{0});
    }
    world.Flush(seconds(5));
  };
  come_and_go(300);
  // The thread sanitizer's shadow of what was touched is resident too.
#ifdef GIVEWAY_THREAD_SANITIZER
  constexpr long kMostKb = 3 * 4096;
#else
  constexpr long kMostKb = 4096;
#endif
  // What piled up while the machine was busy the library keeps, once. What is left behind grows
  // with each thousand.
  constexpr int kThousands = 3;
  long grew_kb = kMostKb;
  for (int i = 0; i < kThousands && grew_kb >= kMostKb; ++i) {
    const long before = MemoryKb();
    come_and_go(1000);
    grew_kb = MemoryKb() - before;
  }
  EXPECT_LT(grew_kb, kMostKb);
}

}  // namespace
}  // namespace giveway::test
