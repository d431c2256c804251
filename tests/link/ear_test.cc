// The discovery probe reports, process by process, how far it came: found, matched, heard.
#include "services/link/ear.h"

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
link::EarProcess Of(link::Ear& ear, VehicleId vehicle) {
  for (const link::EarProcess& process : ear.Listen()) {
    if (process.vehicle == vehicle) return process;
  }
  return {};
}

std::uint64_t Samples(link::Ear& ear, VehicleId vehicle) {
  return Of(ear, vehicle).topics["fleet/beacon"].samples;
}

TEST(Ear, TellsWhoseProcessItHearsAndWhatMatched) {
  const DomainLock domain;
  Beaconing seven(OptionsIn(domain), kSeven);
  link::Ear ear(OptionsIn(domain), {{"fleet/beacon", "main/*"}}, kHearer);
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    return Samples(ear, kSeven) > 0;
  }));
  link::EarProcess heard = Of(ear, kSeven);
  EXPECT_EQ(heard.process, static_cast<std::uint16_t>(getpid()));
  EXPECT_THAT(heard.partitions, Contains("main/v7"));
  EXPECT_TRUE(heard.topics["fleet/beacon"].matched);
}

TEST(Ear, FindsWhomItDoesNotHear) {
  const DomainLock domain;
  Beaconing seven(OptionsIn(domain), kSeven);
  link::Ear ear(OptionsIn(domain), {{"fleet/beacon", "north/*"}}, kHearer);
  link::Ear control(OptionsIn(domain), {{"fleet/beacon", "main/*"}}, kHearer);
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    return Samples(control, kSeven) > 5 && Of(ear, kSeven).vehicle == kSeven;
  }));
  EXPECT_THAT(Of(ear, kSeven).topics, IsEmpty());
}

TEST(Ear, HearsThroughTheImpairmentOfWhoeverItStandsFor) {
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
  link::Ear ear(impaired, {{"fleet/beacon", "main/*"}}, kHearer);
  ASSERT_TRUE(Eventually([&] {
    eight.Send();
    return Samples(ear, kEight) > 0 && Of(ear, kSeven).vehicle == kSeven;
  }));
  const std::uint64_t before = Samples(ear, kSeven);
  const std::uint64_t eights = Samples(ear, kEight);
  ASSERT_TRUE(Eventually([&] {
    seven.Send();
    eight.Send();
    return Samples(ear, kEight) > eights + 20;
  }));
  EXPECT_EQ(Samples(ear, kSeven), before);
}

TEST(Ear, KnowsEveryTopicThatIsReadOnTheRoadAndNoOther) {
  const DomainLock domain;
  std::vector<link::EarTopic> all;
  for (const char* topic :
       {"fleet/beacon", "fleet/motor_command", "fleet/join", "world/ranges", "world/radar",
        "world/lidar", "world/camera", "world/roster", "world/signal"}) {
    all.push_back({topic, "v1"});
  }
  EXPECT_NO_THROW(link::Ear(OptionsIn(domain), all, kHearer));
  EXPECT_THROW(link::Ear(OptionsIn(domain), {{"fleet/rumour", "v1"}}, kHearer), link::LinkError);
}

}  // namespace
}  // namespace giveway::test
