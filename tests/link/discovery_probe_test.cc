// The discovery probe reports, process by process, how far it came: found, matched, heard.
#include "services/link/discovery_probe.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>

#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using testing::Contains;
using testing::IsEmpty;

constexpr VehicleId kSeven{7};
constexpr VehicleId kEight{8};
constexpr VehicleId kHearer{1};

// What is known of a vehicle; nothing if it was not found.
link::ProbedProcess Of(link::DiscoveryProbe& probe, VehicleId vehicle) {
  for (const link::ProbedProcess& process : probe.Poll()) {
    if (process.vehicle == vehicle) return process;
  }
  return {};
}

std::uint64_t Samples(link::DiscoveryProbe& probe, VehicleId vehicle) {
  return Of(probe, vehicle).topics["fleet/beacon"].samples;
}

TEST(DiscoveryProbe, TellsWhoseProcessItHearsAndWhatMatched) {
  const DomainLock domain;
  Beaconing seven(OptionsIn(domain), kSeven);
  link::DiscoveryProbe probe(OptionsIn(domain), {{"fleet/beacon", "main/*"}}, kHearer);
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    return Samples(probe, kSeven) > 0;
  }));
  link::ProbedProcess heard = Of(probe, kSeven);
  EXPECT_EQ(heard.process, static_cast<std::uint16_t>(getpid()));
  EXPECT_THAT(heard.partitions, Contains("main/v7"));
  EXPECT_TRUE(heard.topics["fleet/beacon"].matched);
}

TEST(DiscoveryProbe, FindsWhomItDoesNotHear) {
  const DomainLock domain;
  Beaconing seven(OptionsIn(domain), kSeven);
  link::DiscoveryProbe probe(OptionsIn(domain), {{"fleet/beacon", "north/*"}}, kHearer);
  link::DiscoveryProbe control(OptionsIn(domain), {{"fleet/beacon", "main/*"}}, kHearer);
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    return Samples(control, kSeven) > 5 && Of(probe, kSeven).vehicle == kSeven;
  }));
  EXPECT_THAT(Of(probe, kSeven).topics, IsEmpty());
}

TEST(DiscoveryProbe, HearsThroughTheImpairmentOfWhoeverItStandsFor) {
  const DomainLock domain;
  Beaconing seven(OptionsIn(domain), kSeven);
  Beaconing eight(OptionsIn(domain), kEight);
  link::LinkOptions impaired = OptionsIn(domain);
  ImpairmentRule rule;
  rule.from = ImpairedSender::kOneVehicle;
  rule.from_vehicle = kSeven;
  rule.to_vehicle = kHearer;
  rule.loss = 1;
  impaired.impairment = {.seed = 1, .rules = {rule}};
  link::DiscoveryProbe probe(impaired, {{"fleet/beacon", "main/*"}}, kHearer);
  ASSERT_TRUE(Eventually([&] {
    eight.Send();
    return Samples(probe, kEight) > 0 && Of(probe, kSeven).vehicle == kSeven;
  }));
  const std::uint64_t before = Samples(probe, kSeven);
  const std::uint64_t eights = Samples(probe, kEight);
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    eight.Send();
    return Samples(probe, kEight) > eights + 20;
  }));
  EXPECT_EQ(Samples(probe, kSeven), before);
}

TEST(DiscoveryProbe, KnowsEveryTopicThatIsReadOnTheRoadAndNoOther) {
  const DomainLock domain;
  std::vector<link::ProbeTopic> all;
  for (const char* topic :
       {"fleet/beacon", "fleet/motor_command", "fleet/join", "world/ranges", "world/radar",
        "world/lidar", "world/camera", "world/roster", "world/signal"}) {
    all.push_back({topic, "v1"});
  }
  EXPECT_NO_THROW(link::DiscoveryProbe(OptionsIn(domain), all, kHearer));
  EXPECT_THROW(link::DiscoveryProbe(OptionsIn(domain), {{"fleet/rumour", "v1"}}, kHearer),
               link::LinkError);
}

}  // namespace
}  // namespace giveway::test
