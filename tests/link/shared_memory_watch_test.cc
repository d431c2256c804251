// Shared memory that is deleted while links use it, as by a cleaner of /dev/shm.
#include "services/link/fastdds/shared_memory_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "services/link/fastdds/profile_file.h"
#include "services/link/observer_link.h"
#include "services/link/raw_link.h"
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

// Regression: the world gives its events to a new reader again, and each was counted twice.
TEST(DeletedSharedMemory, AnObserverThatLostItTakesNoEventTwice) {
  const DomainLock domain;
  link::WorldLink world(link::WithoutSharedMemory(OptionsInSharedMemory(domain)));
  link::ObserverLink observer(OptionsInSharedMemory(domain));
  std::vector<std::uint32_t> taken;
  const auto take = [&] {
    for (const WorldEvent& event : observer.Take().events) taken.push_back(event.seq);
  };
  const auto take_until = [&](std::uint32_t seq) {
    return Eventually([&] {
      take();
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
    take();
    return !LacksSegment();
  }));
  send(3);
  ASSERT_TRUE(take_until(3));
  EXPECT_THAT(taken, testing::ElementsAre(1, 2, 3));
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
