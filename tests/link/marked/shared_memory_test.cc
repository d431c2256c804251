// A packet that says its writer has asked the reader's filter already: the library then does not
// ask it, and keeps the sample. In shared memory, which the packet filter does not see, what is
// read is held against the filter's rule once more. Over UDP: udp_test.cc.
#include <gmock/gmock.h>

#include <string>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/profile_file.h"
#include "services/link/observer_link.h"
#include "services/link/world_link.h"
#include "tests/link/marked/marked.h"

namespace giveway::test {
namespace {

constexpr VehicleId kSeven{7};
constexpr SessionId kSession{1, 2, 3, 4};
constexpr double kLie_s = 77;

link::LinkOptions OptionsInSharedMemory(const DomainLock& domain) {
  link::LinkOptions options = OptionsIn(domain);
  options.qos = link::ReadProfileFile(GIVEWAY_QOS_SETS "/same_host.xml");
  return options;
}

TEST(MarkedAsFiltered, ASampleOfAnotherWorldIsNotObserved) {
  const DomainLock domain;
  link::WorldLink world(OptionsInSharedMemory(domain));
  link::ObserverLink observer(OptionsInSharedMemory(domain));
  std::uint32_t tick = 0;
  const auto next = [&] {
    Truth truth;
    truth.vehicle = kSeven;
    truth.epoch = WorldEpoch{1};
    truth.tick = Tick{++tick};
    return truth;
  };
  ASSERT_TRUE(Eventually([&] {
    world.SendTruth(next());
    return !observer.Take().truths.empty();
  }));
  Marked<wire::Truth> intruder(OptionsInSharedMemory(domain), link::kWorldPartition);
  std::uint32_t refused = 0;
  ASSERT_TRUE(Eventually([&] {
    world.SendTruth(next());
    Truth lie = next();
    lie.vehicle = VehicleId{8};
    lie.time_s = kLie_s;
    const bool marked = intruder.Write(link::ToWire(lie));
    const link::Observed observed = observer.Take();
    for (const Truth& truth : observed.truths) EXPECT_NE(truth.time_s, kLie_s);
    refused += observed.refused;
    return marked && refused > 10;
  }));
}

TEST(MarkedAsFiltered, AStatusOfAnotherThanTheFirstIsNotObserved) {
  const DomainLock domain;
  link::VehicleLink vehicle(OptionsInSharedMemory(domain));
  vehicle.Open(kSeven);
  link::ObserverLink observer(OptionsInSharedMemory(domain));
  VehicleStatus status;
  status.vehicle = kSeven;
  ASSERT_TRUE(Eventually([&] {
    vehicle.SendStatus(status);
    return !observer.Take().statuses.empty();
  }));
  Marked<wire::Status> intruder(OptionsInSharedMemory(domain), "v7");
  std::uint32_t refused = 0;
  ASSERT_TRUE(Eventually([&] {
    vehicle.SendStatus(status);
    VehicleStatus lie = status;
    lie.peers_heard = 99;
    const bool marked = intruder.Write(link::ToWire(lie));
    const link::Observed observed = observer.Take();
    for (const VehicleStatus& one : observed.statuses) EXPECT_NE(one.peers_heard, 99U);
    refused += observed.refused;
    return marked && refused > 10;
  }));
}

TEST(MarkedAsFiltered, ACommandOfAnotherThanTheOwnerMovesNoWheels) {
  const DomainLock domain;
  link::WorldLink world(OptionsInSharedMemory(domain));
  link::VehicleLink vehicle(OptionsInSharedMemory(domain));
  vehicle.SendJoin({kSession, kSeven});
  ASSERT_TRUE(Eventually([&] { return !world.TakeJoins().empty(); }));
  RosterEntry entry;
  entry.session = kSession;
  entry.vehicle = kSeven;
  entry.accepted = true;
  entry.epoch = WorldEpoch{1};
  world.SendRoster(entry);
  Marked<wire::MotorCommand> intruder(OptionsInSharedMemory(domain), "v7");
  ASSERT_TRUE(Eventually([&] {
    MotorCommand lie;
    lie.vehicle = kSeven;
    const bool marked = intruder.Write(link::ToWire(lie));
    EXPECT_TRUE(world.TakeCommands().empty());
    return marked && world.Counters().commands_strangers > 10;
  }));
}

}  // namespace
}  // namespace giveway::test
