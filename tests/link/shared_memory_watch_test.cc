// Shared memory that is deleted while links use it, as by a cleaner of /dev/shm.
#include "services/link/fastdds/shared_memory_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "services/link/fastdds/profile_file.h"
#include "services/link/observer_link.h"
#include "services/link/raw_link.h"
#include "services/link/sample_codec.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

constexpr std::size_t kBeacons = 0;  // in RawTopics()

link::LinkOptions OptionsInSharedMemory(const DomainLock& domain) {
  link::LinkOptions options = OptionsIn(domain);
  options.qos = link::ReadProfileFile(GIVEWAY_QOS_SETS "/same_host.xml");
  return options;
}

// Segments and ports of this process, with their locks: those of others stay.
void DeleteOwnSharedMemory() {
  constexpr std::string_view kLock = "_el";
  for (const std::string& file : link::LinksIn("/proc/self/fd")) {
    if (!file.starts_with("/dev/shm/fast") || !file.ends_with(kLock)) continue;
    std::filesystem::remove(file);
    std::filesystem::remove(file.substr(0, file.size() - kLock.size()));
  }
}

std::size_t TopicNamed(std::string_view name) {
  const auto& topics = link::RawTopics();
  return static_cast<std::size_t>(std::ranges::find(topics, name, &link::RawTopic::name) -
                                  topics.begin());
}

std::uint32_t SeqOf(const link::RawSample& event) {
  link::Observed observed;
  EXPECT_EQ(link::DecodeInto("world/event", event.bytes, &observed), link::Decoded::kYes);
  return observed.events.at(0).seq;
}

bool LacksSegment() { return link::IsSegmentGone(link::LinksIn("/proc/self/fd")); }

TEST(SharedMemoryWatch, KnowsTheLockOfAnOwnSegmentThatWasDeleted) {
  EXPECT_TRUE(link::IsSegmentGone({"/dev/shm/fastrtps_6822afdd7747948d_el (deleted)"}));
  EXPECT_TRUE(link::IsSegmentGone({"/dev/null", "/dev/shm/fastdds_6822afdd7747948d_el (deleted)"}));
}

TEST(SharedMemoryWatch, TakesNothingElseForIt) {
  EXPECT_FALSE(link::IsSegmentGone({}));
  EXPECT_FALSE(link::IsSegmentGone({"/dev/shm/fastrtps_6822afdd7747948d_el"}));
  EXPECT_FALSE(link::IsSegmentGone({"/dev/shm/fastrtps_port7664_el (deleted)"}));
  EXPECT_FALSE(link::IsSegmentGone({"/dev/shm/fastrtps_6822afdd7747948d (deleted)"}));
  EXPECT_FALSE(link::IsSegmentGone({"/tmp/fastrtps_6822afdd7747948d_el (deleted)"}));
  EXPECT_FALSE(link::IsSegmentGone({"/dev/shm/fastrtps_6822afdd7747948x_el (deleted)"}));
}

TEST(SharedMemoryWatch, KnowsThePortsThatAProcessReceivesAt) {
  EXPECT_THAT(
      link::PortsOf({"/dev/shm/fastrtps_port7664_el", "/dev/shm/fastdds_port7665_el",
                     "/dev/shm/fastrtps_port7666", "/dev/shm/fastrtps_port7667_el (deleted)",
                     "/dev/shm/fastrtps_6822afdd7747948d_el", "/tmp/fastrtps_port7668_el"}),
      testing::ElementsAre("/dev/shm/fastdds_port7665", "/dev/shm/fastrtps_port7664"));
}

TEST(SharedMemoryWatch, KnowsWhoHoldsAFormerFileOfAPort) {
  const std::string held =
      "7f25aadf9000-7f25aae09000 rw-s 00000000 00:1b 22871   /dev/shm/fastrtps_port7664 (deleted)\n"
      "7f25aae09000-7f25aae19000 rw-s 00000000 00:1b 22934   /dev/shm/fastrtps_port7665\n";
  EXPECT_TRUE(link::HoldsDeleted(held, {"/dev/shm/fastrtps_port7664"}));
  EXPECT_FALSE(link::HoldsDeleted(held, {"/dev/shm/fastrtps_port7665"}));
  EXPECT_FALSE(link::HoldsDeleted(held, {"/dev/shm/fastrtps_port766"}));
  EXPECT_FALSE(link::HoldsDeleted("", {"/dev/shm/fastrtps_port7664"}));
}

// Regression: a world that started while a process ended, ended with it: "basic_filebuf::underflow
// error reading the file: No such process".
TEST(SharedMemoryWatch, AProcessWhoseMapsCannotBeReadIsPassedOver) {
  const std::filesystem::path processes = testing::TempDir() + "/processes";
  std::filesystem::create_directories(processes / "12" / "maps");  // opens, and fails when read
  EXPECT_FALSE(link::AnyHoldsDeleted(processes, {"/dev/shm/fastrtps_port7664"}));
  std::filesystem::create_directories(processes / "13");
  std::ofstream(processes / "13" / "maps")
      << "7f25aadf9000-7f25aae09000 rw-s 00000000 00:1b 22871   /dev/shm/fastrtps_port7664 "
         "(deleted)\n";
  EXPECT_TRUE(link::AnyHoldsDeleted(processes, {"/dev/shm/fastrtps_port7664"}));
  std::filesystem::remove_all(processes);
}

// Regression: a vehicle that stood still for 4 s had its ports replaced, took what its peers still
// had open for a fault, and came back over UDP alone.
TEST(SharedMemoryWatch, APortThatIsReplacedWhileItsOwnerRunsIsNoFault) {
  const DomainLock domain;
  const link::ObserverLink observer(OptionsInSharedMemory(domain));
  const std::set<std::string> ports = link::PortsOf(link::LinksIn("/proc/self/fd"));
  ASSERT_FALSE(ports.empty());
  link::SharedMemoryWatch watch;
  EXPECT_FALSE(watch.IsGone(std::chrono::seconds(1)));
  for (const std::string& port : ports) {
    std::filesystem::remove(port);
    std::ofstream(port) << "another file";
  }
  EXPECT_FALSE(watch.IsGone(std::chrono::seconds(3)));
  EXPECT_TRUE(link::SharedMemoryWatch().IsGone(std::chrono::seconds(3))) << "where it starts";
  for (const std::string& port : ports) std::filesystem::remove(port);
}

TEST(DeletedSharedMemory, AnObserverThatLostItReceivesAVehicleThatStartsLater) {
  const DomainLock domain;
  link::ObserverLink observer(OptionsInSharedMemory(domain));
  EXPECT_FALSE(LacksSegment());
  DeleteOwnSharedMemory();
  EXPECT_TRUE(LacksSegment());
  const BeaconingProcess seven(OptionsInSharedMemory(domain), VehicleId{7});
  EXPECT_TRUE(Eventually([&] { return !observer.Take().beacons.empty(); }));
  EXPECT_FALSE(LacksSegment());
}

// Of who takes events from the world and loses the shared memory behind the second one. `take`
// appends the numbers of those that are there.
void ExpectEachEventOnce(link::WorldLink& world,
                         const std::function<void(std::vector<std::uint32_t>*)>& take) {
  std::vector<std::uint32_t> taken;
  const auto take_until = [&](std::uint32_t seq) {
    return Eventually([&] {
      take(&taken);
      return !taken.empty() && taken.back() == seq;
    });
  };
  const auto send = [&](std::uint32_t seq) {
    world.SendEvent({.seq = seq, .epoch = WorldEpoch{5}, .text = "an event"});
  };
  send(1);
  send(2);
  ASSERT_TRUE(take_until(2));
  DeleteOwnSharedMemory();
  ASSERT_TRUE(Eventually([&] {
    take(&taken);
    return !LacksSegment();
  }));
  send(3);
  ASSERT_TRUE(take_until(3));
  EXPECT_THAT(taken, testing::ElementsAre(1, 2, 3));
}

// Regression: the world gives its events to a new reader again, and each was counted twice.
TEST(DeletedSharedMemory, AnObserverThatLostItTakesNoEventTwice) {
  const DomainLock domain;
  link::WorldLink world(link::WithoutSharedMemory(OptionsInSharedMemory(domain)));
  link::ObserverLink observer(OptionsInSharedMemory(domain));
  ExpectEachEventOnce(world, [&](std::vector<std::uint32_t>* taken) {
    for (const WorldEvent& event : observer.Take().events) taken->push_back(event.seq);
  });
}

// A recording, and clients of Foxglove, got each event of the world twice.
TEST(DeletedSharedMemory, ARecorderThatLostItTakesNoEventTwice) {
  const DomainLock domain;
  link::WorldLink world(link::WithoutSharedMemory(OptionsInSharedMemory(domain)));
  link::RawLink recorder(OptionsInSharedMemory(domain), {TopicNamed("world/event")});
  ExpectEachEventOnce(world, [&](std::vector<std::uint32_t>* taken) {
    recorder.Take([&](const link::RawSample& sample) { taken->push_back(SeqOf(sample)); });
  });
}

TEST(DeletedSharedMemory, ARecorderThatLostItReceivesAVehicleThatStartsLater) {
  const DomainLock domain;
  link::RawLink recorder(OptionsInSharedMemory(domain), {kBeacons});
  DeleteOwnSharedMemory();
  const BeaconingProcess seven(OptionsInSharedMemory(domain), VehicleId{7});
  std::size_t heard = 0;
  EXPECT_TRUE(Eventually([&] {
    recorder.Take([&](const link::RawSample& /*sample*/) { ++heard; });
    return heard > 0;
  }));
  EXPECT_FALSE(LacksSegment());
}

}  // namespace
}  // namespace giveway::test
